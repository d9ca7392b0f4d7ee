"""Tips: pressing a fresh one on the pipette's nose, straight down the axis of its slot, and dropping it over
the waste.

A tip stands in its slot with its upper end at the slot's mouth. With the tip on, the tip's end is where it
was before: at the pipette's frame.
"""

from __future__ import annotations

from fractions import Fraction

from xei_lang.diagnostics import Label
from xei_lang.ir.families import ToolTarget
from xei_lang.ir.geometry import Pose
from xei_lang.ir.skill_plan import ObjectRef, PlaceRef
from xei_lang.lower.operations.base import Aim, Operation, Planned, Work
from xei_lang.lower.operations.lift import along
from xei_lang.lower.operations.pipette import Pipette, held_pipette
from xei_lang.lower.operations.standing import standing_object
from xei_lang.lower.parameters import Layers, Setting, computed_length
from xei_lang.lower.refusal import refuse
from xei_lang.lower.seats import Seat, seat_of
from xei_lang.profiles.grid import is_tip_grid
from xei_lang.profiles.model import LabObject
from xei_lang.quantity import quantity
from xei_lang.quantity.lengths import exact_mm

_CLEAR_M = 0.020
_ABOVE_WASTE_M = 0.020
_FORCE_N = 8
_ALIGNMENT_M = 0.0008
_GRAVITY = 9.80665
_FRICTION = 0.3
"""Of the jaws' pads on a pipette's shell: low, so that the pipette does not slip while it is pressed down."""


def plan_tip(work: Work) -> Planned:
    """The aims `tip_above`, the end of the tip clear of the box, and `tip_on`, the nose seated in the tip."""
    assert isinstance(work.subject, PlaceRef)
    pipette = held_pipette(work)
    seat, box = _seat(work, work.subject, pipette)
    force = _press_force(work, pipette)
    alignment = alignment_tolerance(work.layers)
    depth = pipette.tip.length_m
    rule = f"the tip, {exact_mm(depth)} long, leaves its slot with {exact_mm(_CLEAR_M)} to spare"
    height = work.layers.merge("tip_height", computed_length("tip_height", depth + _CLEAR_M, rule))
    assert height is not None
    if height.si("Length") <= depth:
        refuse(
            "XEI0702",
            f"`tip_height` of {height.text} leaves the tip in its slot",
            height.span or work.span,
            f"expected more than {exact_mm(depth)}",
        )
    T_base_on = work.scene.in_base(work.scene.standing[box.name].T_world_object @ seat.T_host_seat) @ Pose(
        (0.0, 0.0, -depth)
    )
    up = along(T_base_on.axes()[2], height.si("Length"))
    family, turn = pipette.held.family.id, pipette.held.family.symmetric
    settings = (force, alignment, height, pipette.tool_point())
    above = ToolTarget(family, T_base_on, up, turn_reference=turn)
    on = ToolTarget(family, T_base_on, turn_reference=turn)
    return Planned(
        {item.name: item for item in settings},
        {
            "tip_above": Aim(above, (height.name,)),
            "tip_on": Aim(on, (force.name, alignment.name, "tool_point"), entered=(box.name,)),
        },
        pipette.held.family,
    )


def alignment_tolerance(layers: Layers) -> Setting:
    """How far off its axis the nose still finds a tip."""
    return layers.merge("alignment_tolerance", None) or computed_length(
        "alignment_tolerance", _ALIGNMENT_M, "how far off its axis the nose still finds a tip"
    )


def plan_eject(work: Work) -> Planned:
    """The aim `eject`: the end of the tip over the middle of the subject's top."""
    assert isinstance(work.subject, ObjectRef)
    pipette = held_pipette(work)
    waste = standing_object(work, work.subject.name)
    height = work.layers.merge(
        "eject_height", computed_length("eject_height", _ABOVE_WASTE_M, "from the tip's end to the top")
    )
    assert height is not None
    top = work.scene.T_base_object(waste.name).apply((0.0, 0.0, waste.size_m[2] + height.si("Length")))
    family = pipette.held.family
    target = ToolTarget(family.id, pipette.upright(top), turn_reference=family.symmetric)
    return Planned({height.name: height}, {"eject": Aim(target, (height.name,))}, family)


def _seat(work: Work, ref: PlaceRef, pipette: Pipette) -> tuple[Seat, LabObject]:
    """The slot that holds the tip, if its tips are those that the pipette takes."""
    box = work.profile.object(ref.object)
    seat = seat_of(ref, box) if box else None
    if box is None or seat is None:
        refuse("XEI0711", f"there is no place `{ref.object}`", work.span, "not a place of this profile")
    standing_object(work, box.name)
    grid, tip = seat.grid, pipette.tip
    if grid is None or not is_tip_grid(grid, tip):
        found = "no slot" if grid is None else f"its slots are {exact_mm(grid.depth_m)} deep"
        found = f"it accepts {' or '.join(grid.accepts)}" if grid is not None and grid.accepts else found
        refuse(
            "XEI0726",
            f"`{seat.text}` holds no tip for `{pipette.known.name}`",
            work.span,
            f"{found}, the tips are {exact_mm(tip.length_m)} long",
            (Label(tip.span, "the tips are stated here"),),
        )
    return seat, box


def _press_force(work: Work, pipette: Pipette) -> Setting:
    """The force that the tip is pressed on with, no more than arm and jaws are known to bear.

    The arm bears its payload along its whole reach; the jaws hold by friction on both sides.
    """
    rule = "tips of low insertion force"
    default = Setting("press_force", quantity(Fraction(_FORCE_N), "N"), "computed", rule, None)
    force = work.layers.written("press_force") or work.layers.skill.get("press_force") or default
    payload_n = work.profile.calibration.payload_kg * _GRAVITY
    finger = f"openarm_{work.arm}_finger_joint1"
    closing = next((item.torque for item in work.profile.calibration.limits if item.joint == finger), None)
    held_n = 2 * _FRICTION * closing if closing is not None else payload_n
    most, what = min((payload_n, "the arm's payload"), (held_n, "the friction of the jaws"))
    newtons = force.si("Force")
    if not 0.0 < newtons <= most:
        refuse(
            "XEI0702",
            f"`press_force` of {force.text} is more than the robot bears",
            force.span or work.span,
            f"expected more than 0 N and at most {most:.1f} N, {what}",
            (Label(pipette.tip.span, "the tips are stated here"),),
        )
    return force


TIP = Operation(
    "tip",
    ("tip_above", "tip_on"),
    ("press_force", "alignment_tolerance", "tip_height", "tool_point"),
    plan_tip,
    of="Place",
)
EJECT = Operation("eject", ("eject",), ("eject_height",), plan_eject)
