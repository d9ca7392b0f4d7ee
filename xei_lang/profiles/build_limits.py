"""Planning limits of joints, from the validated model; ranges left out are the robot's."""

from __future__ import annotations

from collections.abc import Iterator

from xei_lang.diagnostics import Diagnostic, Span, did_you_mean
from xei_lang.profiles.model import PlanningLimit, RobotDescription, RobotJoint
from xei_lang.profiles.schema.calibration import CalibrationProfile, LimitModel
from xei_lang.profiles.yaml_tree import Node
from xei_lang.quantity import Quantity
from xei_lang.quantity.dimension import ANGLE, LENGTH


def build_limits(
    model: CalibrationProfile, robot: RobotDescription, root: Node, found: list[Diagnostic]
) -> Iterator[PlanningLimit]:
    """The limits of each joint that is named; what does not fit the robot is said in `found`."""
    movable = [joint.name for joint in robot.joints if joint.kind != "fixed" and not joint.mimic]
    for index, limit in enumerate(model.limits):
        for position, name in enumerate(limit.joints):
            span = root.span_of("limits", index, "joints", position)
            joint = robot.joint(name)
            if joint is None or name not in movable:
                near = did_you_mean(name, movable)
                help_ = (
                    f"did you mean `{near[0]}`?"
                    if near
                    else "joints that can be planned: " + ", ".join(movable)
                )
                found.append(
                    Diagnostic(
                        "XEI0620",
                        f"the robot has no joint `{name}` that can be planned",
                        span,
                        label="unknown joint",
                        help=(help_,),
                    )
                )
            elif _units_fit(limit, joint, root, index, found):
                yield _limit(limit, joint, span)


def _limit(limit: LimitModel, joint: RobotJoint, span: Span) -> PlanningLimit:
    effort = limit.torque or limit.force
    return PlanningLimit(
        joint=joint.name,
        lower=limit.lower.si if limit.lower else joint.lower,
        upper=limit.upper.si if limit.upper else joint.upper,
        velocity=limit.velocity.si,
        acceleration=limit.acceleration.si,
        torque=effort.si if effort else joint.effort,
        reason=limit.reason,
        span=span,
    )


def _units_fit(limit: LimitModel, joint: RobotJoint, root: Node, index: int, found: list[Diagnostic]) -> bool:
    base = LENGTH if joint.kind == "prismatic" else ANGLE
    quantities: dict[str, Quantity | None] = {
        "lower": limit.lower,
        "upper": limit.upper,
        "velocity": limit.velocity,
        "acceleration": limit.acceleration,
    }
    for key, value in quantities.items():
        if value is None:
            continue
        wrong = value.dimension.angle != base.angle
        if wrong:
            wanted = "metres" if base == LENGTH else "radians or degrees"
            message = f"`{joint.name}` is {joint.kind}, and `{value}` does not measure its {key}"
            found.append(
                Diagnostic("XEI0610", message, root.span_of("limits", index, key), label=f"expected {wanted}")
            )
            return False
    wrong_effort = (
        "torque"
        if joint.kind == "prismatic" and limit.torque
        else "force"
        if base == ANGLE and limit.force
        else ""
    )
    if wrong_effort:
        other = "force" if wrong_effort == "torque" else "torque"
        message = f"`{joint.name}` is {joint.kind}, and has a {other}, no {wrong_effort}"
        found.append(
            Diagnostic(
                "XEI0610", message, root.key_span("limits", index, wrong_effort), label=f"expected `{other}`"
            )
        )
        return False
    return True
