"""Markdown as tests: each section holds an input block and the text that it must give.

    ## A quantity without its unit

    ```xei
    protocol p { wait 5 }
    ```

    ```text
    error[XEI0302]: ...
    ```

Prose may stand anywhere. An input block is any fenced block whose language is not `text`; it must be followed
by its `text` block. With `update`, the `text` blocks are rewritten (and made where they lack), prose stays.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable
from pathlib import Path

_BLOCK = re.compile(r"^```(?P<language>[a-z]+)\n(?P<body>.*?)^```$\n?", re.DOTALL | re.MULTILINE)


def run_markdown(path: Path, produce: Callable[[str], str], *, update: bool = False) -> None:
    """Run `produce` on each input block of a file and compare with its expected block; all are tried."""
    text = path.read_text(encoding="utf-8")
    blocks = list(_BLOCK.finditer(text))
    inputs = [index for index, block in enumerate(blocks) if block["language"] != "text"]
    assert inputs, f"{path} has no input block"
    rewritten, position, failures = [], 0, []
    for index in inputs:
        block = blocks[index]
        follower = blocks[index + 1] if index + 1 < len(blocks) else None
        expected = follower if follower is not None and follower["language"] == "text" else None
        actual = produce(block["body"])
        assert "```" not in actual, f"{_title(text, block.start())}: the output would end its own block"
        actual = actual if actual.endswith("\n") or not actual else actual + "\n"
        if expected is None or expected["body"] != actual:
            failures.append(_difference(_title(text, block.start()), expected and expected["body"], actual))
        fenced = f"```text\n{actual}```\n"
        if expected is None:
            rewritten += [text[position : block.end()], "\n", fenced]
            position = block.end()
        else:
            rewritten += [text[position : expected.start()], fenced]
            position = expected.end()
    if update:
        path.write_text("".join(rewritten) + text[position:], encoding="utf-8")
    elif failures:
        raise AssertionError(f"{path}\n\n" + "\n".join(failures) + "\n--update-golden writes these anew")


def _title(text: str, offset: int) -> str:
    headings = re.findall(r"^#+ (.*)$", text[:offset], re.MULTILINE)
    return headings[-1] if headings else f"line {text.count(chr(10), 0, offset) + 1}"


def _difference(title: str, expected: str | None, actual: str) -> str:
    if expected is None:
        return f"## {title}\nno expected block; got:\n{actual}"
    lines = difflib.unified_diff(
        expected.splitlines(), actual.splitlines(), "expected", "actual", lineterm="", n=99
    )
    return f"## {title}\n" + "\n".join(lines) + "\n"
