"""Priors name places that exist and that take the object, frames that exist, and lead to a frame."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label, Span
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.grid import T_object_standing, prior_chain, slot_keys
from xei_lang.profiles.model import LabObject, Prior, Profile


def check_priors(profile: Profile) -> Iterator[Diagnostic]:
    """Every prior, and which places two objects would share."""
    roles = {role for item in profile.objects for role in item.roles}
    taken: dict[tuple[str, str, str], LabObject] = {}
    for item in profile.objects:
        prior = item.prior
        if prior is None:
            continue
        if not prior.in_object:
            fixed = ["world", *(frame.name for frame in profile.calibration.frames)]
            if prior.frame not in fixed:
                yield unknown("a frame that stays where it is", prior.frame, fixed, prior.span, "XEI0624")
            continue
        yield from _place(profile, item, prior, roles)
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


def _place(profile: Profile, item: LabObject, prior: Prior, roles: set[str]) -> Iterator[Diagnostic]:
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
        return
    accepts, where = _accepts(holder, prior)
    if accepts is None or set(item.roles) & set(accepts) or not set(accepts) <= roles:
        return  # an unknown role is the mistake, and is told
    shown = ", ".join(f"`{role}`" for role in accepts)
    kind = "into a slot" if prior.in_kind == "slot" else f"on the spot `{prior.in_key}`"
    yield Diagnostic(
        "XEI0624",
        f"`{item.name}` does not go {kind} of `{holder.name}`",
        prior.span,
        label=f"accepts {shown}",
        labels=(Label(where, "the slots' `accepts`" if prior.in_kind == "slot" else "the spot's `accepts`"),),
        help=(f"give `{item.name}` one of the roles {shown}, or put it elsewhere",),
    )


def _accepts(holder: LabObject, prior: Prior) -> tuple[tuple[str, ...] | None, Span]:
    """The roles that the place takes, None for any, and where that is stated."""
    if prior.in_kind == "slot":
        return (holder.slots.accepts, holder.slots.span) if holder.slots else (None, holder.span)
    spot = next((spot for spot in holder.spots if spot.name == prior.in_key), None)
    return (spot.accepts or None, spot.span) if spot else (None, holder.span)
