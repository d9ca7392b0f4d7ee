"""The form of test reports that build servers show: one test case for each file that was checked.

The form is the common core of what JUnit, its Ant task and their readers agree on: at most one `failure` a
case, warnings in `system-out`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape

from xei_lang.diagnostics.diagnostic import Diagnostics
from xei_lang.diagnostics.render.full import render_full
from xei_lang.diagnostics.render.terminal import visible
from xei_lang.diagnostics.span import Sources

Checked = tuple[str, Diagnostics]
"""A file that was checked, as it is shown, and all that was said while checking it."""


def render_junit(checked: Sequence[Checked], sources: Sources) -> str:
    """One suite with a case for each file, in their order. A case fails where there is an error.

    What cannot stand in XML 1.0, and whatever else does not print, is spelled out as `<U+001B>`.
    """
    failed = sum(any(item.severity == "error" for item in said) for _, said in checked)
    counts = f'tests="{len(checked)}" failures="{failed}" errors="0"'
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<testsuites name="xei check" {counts}>',
        f'  <testsuite name="xei check" {counts} skipped="0">',
        *(line for file, said in checked for line in _case(file, said, sources)),
        "  </testsuite>",
        "</testsuites>",
    ]
    return "\n".join(lines) + "\n"


def _case(file: str, said: Diagnostics, sources: Sources) -> Iterator[str]:
    name = escape(visible(file))
    case = f'    <testcase classname="xei.check" name="{name}" file="{name}"'
    if not said:
        yield f"{case}/>"
        return
    yield f"{case}>"
    errors = [item for item in said if item.severity == "error"]
    if errors:
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        headline = visible(errors[0].message.partition("\n")[0]) + more
        body = escape(render_full(tuple(errors), sources), quote=False)
        yield f'      <failure type="{errors[0].code}" message="{escape(headline)}">{body}</failure>'
    others = tuple(item for item in said if item.severity != "error")
    if others:
        yield f"      <system-out>{escape(render_full(others, sources), quote=False)}</system-out>"
    yield "    </testcase>"
