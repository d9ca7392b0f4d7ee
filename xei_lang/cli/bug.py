"""What is said of a bug in xei: where it happened, and that it is none of the user's."""

from __future__ import annotations


class ReportedBugError(Exception):
    """A bug that was already put into lines to show, such as one in another process."""

    def __init__(self, lines: list[str]) -> None:
        super().__init__(lines[-1])
        self.lines = lines


def bug_lines(bug: BaseException) -> list[str]:
    """The lines to show, for a report; the last frames are enough to find the place."""
    import traceback

    from xei_lang.diagnostics.render.terminal import visible

    if isinstance(bug, ReportedBugError):
        return bug.lines
    frames = traceback.extract_tb(bug.__traceback__)[-6:]
    places = [
        f"{frame.name} ({frame.filename.rpartition('xei_lang/')[2]}:{frame.lineno})" for frame in frames
    ]
    return [
        "internal error: this is a bug in xei, not in your protocol",
        "  please report it with these lines and, if you may, the protocol that caused it",
        *(f"  {visible(place)}" for place in places),
        f"  {visible(f'{type(bug).__name__}: {bug}')}",
    ]
