"""The blockers of a profile as JSON, and as text for people."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from xei_lang.diagnostics import Source
from xei_lang.doctor.blocker import STAGES, Blocker, Stage
from xei_lang.ir.forms.canonical import Json

VERSION = 1
_STANDS: Mapping[Stage, str] = {
    "simulate": "simulation",
    "strict": "a strict compilation",
    "hardware": "a run on hardware",
}


def blocker_json(blocker: Blocker) -> dict[str, Json]:
    """One blocker as `xei doctor --format json` and the manifest of a bundle have it."""
    return {
        "code": blocker.code,
        "representation": blocker.representation,
        "item": blocker.item,
        "status": blocker.status,
        "blocks": blocker.blocks,
        "measure": blocker.measure,
        "write_to": blocker.write_to,
    }


def to_json(blockers: Sequence[Blocker]) -> dict[str, Json]:
    """What `xei doctor --format json` prints."""
    return {"version": VERSION, "blockers": [blocker_json(blocker) for blocker in blockers]}


def to_text(profile: str, blockers: Sequence[Blocker], sources: Mapping[str, Source]) -> str:
    """The same by representation, each with what to do about it and the line to write to.

    `sources` are the texts that places are told in; a blocker whose text is not among them has its item.
    """
    if not blockers:
        return f"{profile}: nothing stands in the way\n"
    lines: list[str] = []
    for representation in dict.fromkeys(blocker.representation for blocker in blockers):
        lines.append(representation)
        for blocker in (item for item in blockers if item.representation == representation):
            lines += _entry(blocker, sources)
        lines.append("")
    lines += _summary(profile, blockers)
    return "\n".join(lines) + "\n"


def _entry(blocker: Blocker, sources: Mapping[str, Source]) -> Iterator[str]:
    yield f"  {blocker.item}: {blocker.status}, blocks {_STANDS[blocker.blocks]} [{blocker.code}]"
    yield f"    do: {blocker.measure}"
    yield f"    write to: {blocker.write_to}{_place(blocker, sources)}"


def _place(blocker: Blocker, sources: Mapping[str, Source]) -> str:
    source = sources.get(blocker.span.file) if blocker.span else None
    if blocker.span is None or source is None:
        return ""
    return f" ({source.file}:{source.line_number(blocker.span.start)})"


def _summary(profile: str, blockers: Sequence[Blocker]) -> Iterator[str]:
    """For each stage, how many blockers stand before it: those of the milder stages stop it, too."""
    stopped = 0
    for stage in STAGES:
        stopped += sum(blocker.blocks == stage for blocker in blockers)
        count = f"{stopped} blocker{'' if stopped == 1 else 's'}" if stopped else "nothing"
        yield f"{profile}: {count} before {_STANDS[stage]}"
