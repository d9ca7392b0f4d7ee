"""A world that cannot be grounded, because what the profile says of its objects contradicts itself."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.doctor.blocker import Blocker
from xei_lang.profiles.model import Profile
from xei_lang.world.ground import ground


def grounding_blockers(profile: Profile) -> Iterator[Blocker]:
    """One blocker for each error that grounding by the profile alone meets; nothing can be made then."""
    for said in ground(profile)[1]:
        if said.severity == "error":
            measure = "; ".join(said.help) or said.label or "correct what the profile says"
            where = said.span.file.rsplit("/", 1)[-1] if said.span else "usage_profile.yaml"
            yield Blocker(said.code, "world", said.message, "error", "simulate", measure, where, said.span)
