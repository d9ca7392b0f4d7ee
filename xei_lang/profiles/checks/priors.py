"""Priors name places that exist and that take the object, frames that exist, and lead to a frame."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.grid import T_object_standing, T_world_frame, prior_chain, slot_keys
from xei_lang.profiles.model import LabObject, Prior, Profile


def check_priors(profile: Profile) -> Iterator[Diagnostic]:
    """Every prior, and then which places two objects would share."""
    taken: dict[tuple[str, str, str], LabObject] = {}
    for item in profile.objects:
        prior = item.prior
        if prior is None:
            continue
        if not prior.in_object:
            if T_world_frame(profile, prior.frame) is None:
                frames = ["world", *(frame.name for frame in profile.calibration.frames)]
                yield unknown("a frame that stays where it is", prior.frame, frames, prior.span, "XEI0624")
            continue
        yield from _place(profile, item, prior)
        place = (prior.in_object, prior.in_kind, prior.in_key)
        if place in taken:
            other = taken[place]
            text = f'{prior.in_object}.{prior.in_kind}("{prior.in_key}")'
            yield Diagnostic(
                "XEI0641",
                f"`{item.name}` and `{other.name}` stand in the same place",
                prior.span,
                label=f"{text} is taken",
                labels=(Label(other.prior.span if other.prior else other.span, f"by `{other.name}`"),),
                help=("move one of the two to a free place",),
            )
        taken.setdefault(place, item)


def _place(profile: Profile, item: LabObject, prior: Prior) -> Iterator[Diagnostic]:
    holder = profile.object(prior.in_object)
    if holder is None:
        yield unknown(
            "an object", prior.in_object, [other.name for other in profile.objects], prior.span, "XEI0624"
        )
        return
    last = prior_chain(profile, item)[-1].prior
    if last is None or last.in_object:
        yield Diagnostic(
            "XEI0624",
            f"nothing says where `{holder.name}` is, in which `{item.name}` should stand",
            prior.span,
            label="leads to no frame",
            help=(f"give `{holder.name}` a prior in a frame",),
        )
    if T_object_standing(holder, prior.in_kind, prior.in_key) is None:
        keys = (
            slot_keys(holder.slots)
            if prior.in_kind == "slot" and holder.slots
            else [spot.name for spot in holder.spots]
        )
        yield unknown(
            f"a {prior.in_kind} of `{holder.name}`", prior.in_key, keys if keys else (), prior.span, "XEI0624"
        )
    elif prior.in_kind == "slot" and holder.slots and not set(item.roles) & set(holder.slots.accepts):
        accepts = ", ".join(f"`{role}`" for role in holder.slots.accepts)
        yield Diagnostic(
            "XEI0624",
            f"`{item.name}` does not go into a slot of `{holder.name}`",
            prior.span,
            label=f"accepts {accepts}",
            labels=(Label(holder.slots.span, "the slots' `accepts`"),),
            help=(f"give `{item.name}` one of the roles {accepts}, or put it elsewhere",),
        )
