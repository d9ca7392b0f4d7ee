"""Fixes mend what they are offered for."""

from __future__ import annotations

import pytest

from tests.check.checking import check, protocol


@pytest.mark.parametrize(
    ("wrong", "right", "applicability"),
    [
        ("pick(tube_1)", "pick(object=tube_1)", "safe"),
        ('pick(object="tube_1")', "pick(object=tube_1)", "safe"),
        ("pick(objct=tube_1)", "pick(object=tube_1)", "unsafe"),
        (
            "spin(object=tube_1, force=3000 g, for=1 min)",
            "spin(object=tube_1, force=3000 xg, for=1 min)",
            "safe",
        ),
        ("wait 10 m", "wait 10 min", "unsafe"),
        ("if True { wait 1 s }", "if true { wait 1 s }", "safe"),
        ("if FALSE { wait 1 s }", "if false { wait 1 s }", "safe"),
        ("pik(object=tube_1)", "pick(object=tube_1)", "unsafe"),
        ("pick(object=tube_1, arm=rihgt)", "pick(object=tube_1, arm=right)", "unsafe"),
        ("given cap(tube_1) == closd", "given cap(tube_1) == closed", "unsafe"),
        ("given cpa(tube_1) == closed", "given cap(tube_1) == closed", "unsafe"),
        (
            "object x: movble = tube_1\n  pick(object=x)",
            "object x: movable = tube_1\n  pick(object=x)",
            "unsafe",
        ),
        ("if leng([1]) > 0 { wait 1 s }", "if len([1]) > 0 { wait 1 s }", "unsafe"),
        ("wait len(rack_1.slts) * 1 s", "wait len(rack_1.slots) * 1 s", "unsafe"),
        (
            "start a: shake(object=tube_1)\n  await a\n  await a\n  wait 1 s",
            "start a: shake(object=tube_1)\n  await a\n  wait 1 s",
            "safe",
        ),
        ('pick(object=table.spot("cups"))', 'pick(object=table.spot("cup"))', "unsafe"),
    ],
)
def test_a_fix_leaves_nothing_to_mend(wrong: str, right: str, applicability: str) -> None:
    text = protocol(wrong)
    _, (found,) = check(text)
    assert found.fix is not None
    assert found.fix.applicability == applicability
    for edit in sorted(found.fix.edits, key=lambda edit: edit.span, reverse=True):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert text == protocol(right)
    assert check(text)[1] == ()


def test_a_guess_is_never_a_fix() -> None:
    for body in ("pour(source=cup_1, target=tube_1, volume=30 s)", "wait 5", "pick(object=tube_11)"):
        _, (found,) = check(protocol(body))
        assert found.fix is None
