"""What was seen on its side or its head and should stand: said, for numbers in another order look just so."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic
from xei_lang.profiles.checks.leaning import lean_text, leans, turned_text
from xei_lang.profiles.model import LabObject
from xei_lang.world.sources.contradictions import Known


def turned(known: tuple[Known, ...]) -> Iterator[Diagnostic]:
    """A warning for each vessel, and each object whose prior stands upright, that was seen otherwise."""
    for one in known:
        seen, pose = one.belief.seen, one.standing.T_world_object
        if seen is None or one.belief.item.system or not leans(pose) or not should_stand(one.belief.item):
            continue
        said_by = () if seen.span else (f"said by {seen.source}",)
        note = "grasps and what a vessel holds go by an object's own frame, z up as it is used"
        yield Diagnostic(
            "XEI0659",
            f"`{one.name}` {lean_text(pose)}",
            seen.span,
            label="is turned so" if seen.span else "",
            notes=(turned_text(pose), note, *said_by),
            help=(
                "put it upright and look again, or correct how it is turned: quaternions are x, y, z, w, and "
                "[0, 0, 0, 1] is upright",
            ),
        )


def should_stand(item: LabObject) -> bool:
    """Whether it is a vessel, or the profile does not itself have it lie."""
    prior = item.prior
    lies_by_prior = prior is not None and not prior.in_object and leans(prior.T_frame_object)
    return item.liquid is not None or not lies_by_prior
