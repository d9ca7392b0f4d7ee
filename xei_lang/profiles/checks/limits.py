"""Planning limits against the robot: every joint has one set, inside its range and its motor's rating."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Label
from xei_lang.profiles.model import PlanningLimit, Profile, RobotJoint
from xei_lang.profiles.trees import Trees

_SLACK = 1e-9


def check_limits(profile: Profile, trees: Trees) -> Iterator[Diagnostic]:
    """Joints without limits or with two sets, limits beyond the description, starts outside of them."""
    seen: dict[str, PlanningLimit] = {}
    for limit in profile.calibration.limits:
        if limit.joint in seen:
            yield Diagnostic(
                "XEI0651",
                f"`{limit.joint}` has planning limits twice",
                limit.span,
                label="given again here",
                labels=(Label(seen[limit.joint].span, "first given here"),),
            )
        seen.setdefault(limit.joint, limit)
        joint = profile.robot.joint(limit.joint)
        if joint is not None:
            yield from _fits(limit, joint)
    for joint in profile.robot.joints:
        if joint.kind != "fixed" and not joint.mimic and joint.name not in seen:
            yield Diagnostic(
                "XEI0651",
                f"`{joint.name}` has no planning limits",
                trees.calibration.key_span("limits"),
                label="expected an entry for each joint that moves",
                notes=(f"its motor is rated {joint.velocity:g} and {joint.effort:g} (rad, m, s, N)",),
                help=("name it under `limits` in the calibration profile",),
            )
    yield from _stations(profile, seen, trees)


def _fits(limit: PlanningLimit, joint: RobotJoint) -> Iterator[Diagnostic]:
    if not joint.lower - _SLACK <= limit.lower < limit.upper <= joint.upper + _SLACK:
        yield _beyond(
            limit, "range", f"{limit.lower:g} .. {limit.upper:g}", f"{joint.lower:g} .. {joint.upper:g}"
        )
    if not 0.0 < limit.velocity <= joint.velocity + _SLACK:
        yield _beyond(limit, "velocity", f"{limit.velocity:g}", f"at most {joint.velocity:g}")
    if not 0.0 < limit.torque <= joint.effort + _SLACK:
        yield _beyond(limit, "effort", f"{limit.torque:g}", f"at most {joint.effort:g}")
    if limit.acceleration <= 0.0:
        yield _beyond(limit, "acceleration", f"{limit.acceleration:g}", "above zero")


def _beyond(limit: PlanningLimit, what: str, stated: str, allowed: str) -> Diagnostic:
    return Diagnostic(
        "XEI0651",
        f"the {what} limit of `{limit.joint}` does not fit the robot",
        limit.span,
        label=f"{stated}, and the description has {allowed} (rad, m, s, N)",
        notes=("the description holds the motors' rated figures; a plan must stay within them",),
        help=(f"state a {what} within the description's",),
    )


def _stations(profile: Profile, limits: dict[str, PlanningLimit], trees: Trees) -> Iterator[Diagnostic]:
    link = dict(profile.calibration.robot_frames).get("slide", "")
    slide = next((joint.name for joint in profile.robot.joints if joint.child == link), "")
    if slide not in limits:
        return
    lower, upper = limits[slide].lower, limits[slide].upper
    for station in profile.calibration.stations:
        if not lower <= station.slide_m <= upper:
            yield Diagnostic(
                "XEI0651",
                f"the slide cannot stand at {station.slide_m:g} m at `{station.name}`",
                trees.calibration.span_of("stations", station.name, "slide"),
                label=f"expected {lower:g} .. {upper:g} m",
            )
