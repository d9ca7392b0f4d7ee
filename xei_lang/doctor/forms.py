"""The blockers of a profile as JSON, and as text for people."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from xei_lang.diagnostics import Diagnostics
from xei_lang.doctor.blocker import Blocker, Stage
from xei_lang.doctor.places import Place
from xei_lang.doctor.readiness import readiness
from xei_lang.ir.forms.canonical import Json

VERSION = 1
_STANDS: Mapping[Stage, str] = {
    "simulate": "simulation",
    "strict": "a strict compilation",
    "hardware": "a run on hardware",
}


def blocker_json(blocker: Blocker) -> dict[str, Json]:
    """One blocker as the manifest of a bundle has it."""
    return {
        "code": blocker.code,
        "representation": blocker.representation,
        "item": blocker.item,
        "status": blocker.status,
        "blocks": blocker.blocks,
        "measure": blocker.measure,
        "write_to": blocker.write_to,
    }


def readiness_json(blockers: Sequence[Blocker]) -> list[Json]:
    """For each use whether the profile is ready for it, and how many blockers stand before it."""
    return [
        {
            "stage": row.stage,
            "ready": not row.blockers,
            "blockers": row.blockers,
            "by_representation": dict(row.by_representation),
        }
        for row in readiness(blockers)
    ]


def to_json(
    blockers: Sequence[Blocker], places: Mapping[Blocker, Place], warnings: Diagnostics = ()
) -> dict[str, Json]:
    """What `xei doctor --format json` prints."""
    told: list[Json] = []
    for blocker in blockers:
        file, line = places.get(blocker, (None, None))
        told.append({**blocker_json(blocker), "file": file, "line": line})
    return {
        "version": VERSION,
        "readiness": readiness_json(blockers),
        "blockers": told,
        "warnings": [{"code": one.code, "message": one.message} for one in warnings],
    }


def to_text(profile: str, blockers: Sequence[Blocker], places: Mapping[Blocker, Place]) -> str:
    """The same by representation and kind: what to do, and below it each item with the line to write to.

    Items that ask for the same are told together.
    """
    if not blockers:
        return f"{profile}: nothing stands in the way\n"
    lines: list[str] = []
    for name in dict.fromkeys(blocker.representation for blocker in blockers):
        own = [item for item in blockers if item.representation == name]
        lines.append(f"{name}: {_count(len(own))}")
        for kind in dict.fromkeys(_kind(item) for item in own):
            lines += _group([item for item in own if _kind(item) == kind], places)
        lines.append("")
    lines += _summary(profile, blockers)
    return "\n".join(lines) + "\n"


def _kind(blocker: Blocker) -> tuple[str, str, Stage]:
    return blocker.code, blocker.status, blocker.blocks


def _group(blockers: Sequence[Blocker], places: Mapping[Blocker, Place]) -> Iterator[str]:
    code, status, blocks = _kind(blockers[0])
    yield f"  {len(blockers)} {status}, before {_STANDS[blocks]} [{code}]"
    together: dict[str, list[Blocker]] = {}
    for blocker in blockers:
        together.setdefault(_measure_of_each(blocker), []).append(blocker)
    for measure, same in together.items():
        yield f"    {same[0].measure if len(same) == 1 else measure}"
        width = max(len(one.item) for one in same)
        yield from (f"      {one.item.ljust(width)}  {_place(one, places)}" for one in same)


def _measure_of_each(blocker: Blocker) -> str:
    """What to do, with `each` in the place of the item's own name."""
    measure = blocker.measure
    for word in blocker.item.split("."):
        measure = measure.replace(f"`{word}`", "each")
    return measure


def _place(blocker: Blocker, places: Mapping[Blocker, Place]) -> str:
    """The file and line, with the item of the line where it is another one; the item where there is none."""
    file, line = places.get(blocker, ("", 0))
    if not file:
        return blocker.write_to
    inside = blocker.write_to.partition(":")[2]
    return f"{file}:{line}" + (f" ({inside})" if inside not in ("", blocker.item) else "")


def _summary(profile: str, blockers: Sequence[Blocker]) -> Iterator[str]:
    """For each stage, how many blockers stand before it: those of the milder stages stop it, too."""
    for row in readiness(blockers):
        count = _count(row.blockers) if row.blockers else "nothing"
        parts = ", ".join(f"{name} {number}" for name, number in row.by_representation)
        detail = f" ({parts})" if len(row.by_representation) > 1 else ""
        yield f"{profile}: {count} before {_STANDS[row.stage]}{detail}"


def _count(number: int) -> str:
    return f"{number} blocker{'' if number == 1 else 's'}"
