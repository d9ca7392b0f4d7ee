"""Threads of caps: the vessel and the rest that they name, what these take, and one cap for each mouth."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label, Span
from xei_lang.profiles.checks.unknown import unknown
from xei_lang.profiles.model import LabObject, Profile, Spot, Thread
from xei_lang.profiles.trees import Trees
from xei_lang.quantity.lengths import exact_mm

MOST_LEAD_M = 0.02
"""Coarser than any screw cap: a lead of this much per turn would not hold by itself."""
_OFF_AXIS_M = 0.0005


def check_threads(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Every cap that has a thread."""
    closed: dict[tuple[str, str], LabObject] = {}
    for item in profile.objects:
        if item.thread is None:
            continue
        yield from _Cap(profile, trees, item, item.thread).faults()
        mouth = (item.thread.on_object, item.thread.on_key)
        if mouth in closed:
            other = closed[mouth]
            yield Diagnostic(
                "XEI0646",
                f"`{item.name}` and `{other.name}` close the same mouth",
                trees.of_object(item, "thread", "closes"),
                label="one mouth, one cap",
                labels=(Label(trees.of_object(other, "thread", "closes"), f"the mouth of `{other.name}`"),),
                help=("give each cap a mouth of its own",),
            )
        closed.setdefault(mouth, item)


class _Cap:
    """One cap against the objects that its thread names."""

    def __init__(self, profile: Profile, trees: Trees, item: LabObject, thread: Thread) -> None:
        self.profile, self.trees, self.item, self.thread = profile, trees, item, thread

    def faults(self) -> Iterator[Diagnostic]:
        """What does not fit."""
        item, thread = self.item, self.thread
        if "movable" not in item.roles:
            span = self.trees.of_object(item, "roles")
            help_ = "add the role `movable`"
            yield self.say(span, f"`{item.name}` has a thread and is not movable", "is a cap", help_)
        if thread.lead_m > MOST_LEAD_M:
            span = self.trees.of_object(item, "thread", "lead")
            label = f"expected at most {exact_mm(MOST_LEAD_M)} in a whole turn"
            yield self.say(
                span, f"the thread of `{item.name}` is too steep to hold", label, "measure it again"
            )
        yield from self.named("closes", thread.on_object, thread.on_key)
        yield from self.named("rest", thread.rest_object, thread.rest_key)

    def named(self, key: str, name: str, place: str) -> Iterator[Diagnostic]:
        """The place that a thread names: there is one, and it takes the cap."""
        span = self.trees.of_object(self.item, "thread", key)
        host = self.profile.object(name)
        if host is None:
            known = [other.name for other in self.profile.objects]
            yield unknown("an object", name, known, span)
            return
        spot = next((item for item in host.spots if item.name == place), None)
        if spot is None:
            yield unknown(f"a spot of `{name}`", place, [item.name for item in host.spots], span)
            return
        if not accepted(spot, self.item.roles):
            yield Diagnostic(
                "XEI0646",
                f"`{self.item.name}` does not go on the spot `{place}` of `{name}`",
                span,
                label=f"accepts {_listed(spot.accepts)}",
                labels=(Label(spot.span, "the spot is stated here"),),
                help=(f"give `{self.item.name}` one of these roles, or name another spot",),
            )
        if key == "closes":
            yield from self.vessel(host, spot)
        elif "movable" in host.roles:
            message = f"`{self.item.name}` cannot rest on `{name}`, which is movable"
            yield self.say(span, message, "expected a fixture", "name a spot of a table or of a cap rest")

    def vessel(self, host: LabObject, mouth: Spot) -> Iterator[Diagnostic]:
        """What a cap closes is movable, and its mouth points up in its middle."""
        span = self.trees.of_object(self.item, "thread", "closes")
        if "movable" not in host.roles:
            message = f"`{self.item.name}` closes `{host.name}`, which is not movable"
            help_ = "a hand holds what another one opens: name a movable object"
            yield self.say(span, message, "expected a movable object", help_)
            return
        if not mouth.accepts:
            message = f"the mouth of `{host.name}` takes anything"
            help_ = f"write `accepts: [{_cap_role(self.item)}]` at the spot `{mouth.name}`"
            yield self.say(span, message, "expected a spot that accepts caps alone", help_)
        x, y, _ = mouth.T_object_spot.position_m
        upright = mouth.T_object_spot.axes()[2][2] > 1.0 - 1e-6
        if max(abs(x), abs(y)) > _OFF_AXIS_M or not upright:
            message = f"the mouth of `{host.name}` is not in the middle of its top"
            help_ = "a hand turns the cap about the vessel's own axis: put the spot on it, pointing up"
            yield self.say(mouth.span, message, "expected [0 mm, 0 mm, ...], not tilted", help_)

    def say(self, span: Span, message: str, label: str, help_: str) -> Diagnostic:
        """A thread that does not fit."""
        return Diagnostic("XEI0646", message, span, label=label, help=(help_,))


def accepted(spot: Spot, roles: tuple[str, ...]) -> bool:
    """Whether a spot takes an object of these roles."""
    return not spot.accepts or any(role in spot.accepts for role in roles)


def _cap_role(item: LabObject) -> str:
    return next((role for role in item.roles if role != "movable"), "cap")


def _listed(names: tuple[str, ...]) -> str:
    return ", ".join(f"`{name}`" for name in names)
