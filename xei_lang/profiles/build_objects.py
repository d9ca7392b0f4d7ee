"""Objects of the usage profile and the registry, from validated models to dataclasses with places."""

from __future__ import annotations

import math

from xei_lang.diagnostics import Diagnostic
from xei_lang.ir.geometry import Box, Cylinder, Pose, Primitive, Shape, Vec3
from xei_lang.profiles.build_assets import AssetReader, read_assets
from xei_lang.profiles.build_thread import build_thread, named_place
from xei_lang.profiles.model import (
    Element,
    FiniteState,
    LabObject,
    Liquid,
    OperationDefault,
    Prior,
    SlotGrid,
    Spot,
    Tip,
)
from xei_lang.profiles.schema.usage import ObjectModel, PriorModel, ShapeModel
from xei_lang.profiles.vectors import pose, vec3
from xei_lang.profiles.yaml_tree import Node, Path
from xei_lang.quantity import Quantity

_KINDS = ("box", "cylinder", "mesh", "point_cloud")


def build_object(
    model: ObjectModel, root: Node, path: Path, reader: AssetReader, *, system: bool, found: list[Diagnostic]
) -> LabObject | None:
    """The object at `path`, named by its end; None, with diagnostics in `found`, where parts do not fit."""
    kind = _kind(model.shape, root, (*path, "shape"), found)
    shaped = read_assets(model, _stated(model.shape), root, path, reader, found) if kind else None
    shape = shaped.shape if shaped else None
    parts = _parts(model, shape, root, path, found)
    prior = _prior(model.prior, root, (*path, "prior"), found) if model.prior else None
    thread, is_threaded = build_thread(model.thread, root, (*path, "thread"), found)
    if shaped is None or shape is None or parts is None or not is_threaded:
        return None
    return LabObject(
        name=str(path[-1]),
        aliases=tuple(model.aliases),
        roles=tuple(model.roles),
        shape=shape,
        geometry=parts,
        size_m=_size(shape),
        mass_kg=model.mass.si if model.mass else 0.0,
        skills=tuple(model.skills or ()),
        skills_span=None if model.skills is None else root.span_of(*path, "skills"),
        states=_states(model, root, path),
        liquid=_liquid(model),
        grasp=operation_defaults(model.grasp, root, (*path, "grasp")),
        slots=_slots(model, root, path),
        spots=tuple(
            Spot(key, pose(spot.position, spot.rpy), root.key_span(*path, "spots", key), tuple(spot.accepts))
            for key, spot in model.spots.items()
        ),
        elements=_elements(model, root, path),
        tip=_tip(model, root, path),
        thread=thread,
        prior=prior,
        assets=shaped.named,
        models=shaped.models,
        computed_from=shaped.computed_from,
        system=system,
        span=root.key_span(*path),
        mass_span=root.span_of(*path, "mass") if model.mass else None,
    )


def operation_defaults(
    values: dict[str, Quantity | str], root: Node, path: Path
) -> tuple[OperationDefault, ...]:
    """Operation parameters that a profile states, in the order in which it states them."""
    return tuple(OperationDefault(key, value, root.span_of(*path, key)) for key, value in values.items())


def _kind(model: ShapeModel, root: Node, path: Path, found: list[Diagnostic]) -> str:
    """What a shape is given by; empty, with why in `found`, where that is nothing or more than one."""
    kinds = [name for name in _KINDS if name in type(model).model_fields]
    given = [name for name in kinds if getattr(model, name) is not None]
    if len(given) == 1:
        return given[0]
    names = [f"`{name}`" for name in kinds]
    found.append(
        Diagnostic(
            "XEI0609",
            f"a shape must be one of {', '.join(names[:-1])} and {names[-1]}",
            root.span_of(*path),
            label=f"expected just one of the {'two' if len(kinds) == 2 else 'four'}",
        )
    )
    return ""


def _stated(model: ShapeModel) -> Shape | None:
    """The box or the cylinder that a profile states; None where a shape is taken from a file."""
    if model.box is not None:
        return Box(vec3(model.box))
    if model.cylinder is not None:
        return Cylinder(model.cylinder.diameter.si / 2, model.cylinder.height.si)
    return None


def _parts(
    model: ObjectModel, shape: Shape | None, root: Node, path: Path, found: list[Diagnostic]
) -> tuple[Primitive, ...] | None:
    """The collision primitives: those given, else the shape itself standing on the object's frame."""
    if model.collision is None:
        return (Primitive(shape, Pose((0.0, 0.0, _size(shape)[2] / 2))),) if shape else None
    parts: list[Primitive] = []
    for index, part in enumerate(model.collision):
        built = _stated(part) if _kind(part, root, (*path, "collision", index), found) else None
        if built is None:
            return None
        parts.append(Primitive(built, pose(part.position, part.rpy)))
    return tuple(parts)


def _size(shape: Shape) -> Vec3:
    """The edges of the bounding box of a shape that stands upright, metres."""
    if isinstance(shape, Box):
        return shape.size_m
    across = 2 * shape.radius_m
    return (across, across, shape.height_m if isinstance(shape, Cylinder) else across)


def _states(model: ObjectModel, root: Node, path: Path) -> tuple[FiniteState, ...]:
    return tuple(
        FiniteState(key, tuple(state.values), state.initial, root.key_span(*path, "states", key))
        for key, state in model.states.items()
    )


def _liquid(model: ObjectModel) -> Liquid | None:
    liquid = model.liquid
    return Liquid(liquid.capacity.si, liquid.dead_volume.si, liquid.inner_diameter.si) if liquid else None


def _slots(model: ObjectModel, root: Node, path: Path) -> SlotGrid | None:
    slots = model.slots
    if slots is None:
        return None
    return SlotGrid(
        rows=tuple(slots.rows),
        columns=slots.columns,
        pitch_m=(slots.pitch[0].si, slots.pitch[1].si),
        origin_m=vec3(slots.origin),
        bore_m=slots.bore.si,
        chamfer_m=slots.chamfer.si,
        depth_m=slots.depth.si,
        accepts=tuple(slots.accepts),
        span=root.key_span(*path, "slots"),
    )


def _tip(model: ObjectModel, root: Node, path: Path) -> Tip | None:
    tip = model.tip
    if tip is None:
        return None
    span = root.key_span(*path, "tip")
    return Tip(tip.length.si, tip.diameter.si, tip.seat.si, tip.capacity.si, span)


def _elements(model: ObjectModel, root: Node, path: Path) -> tuple[Element, ...]:
    return tuple(
        Element(
            key,
            (item.center[0].si, item.center[1].si),
            (item.size[0].si, item.size[1].si),
            root.key_span(*path, "elements", key),
        )
        for key, item in model.elements.items()
    )


def _prior(model: PriorModel, root: Node, path: Path, found: list[Diagnostic]) -> Prior | None:
    span = root.span_of(*path)
    if (model.in_ is None) == (model.frame is None) or (model.frame and model.position is None):
        found.append(
            Diagnostic(
                "XEI0609",
                "a prior names either a place or a pose in a frame",
                span,
                label="expected `in`, or `frame` with `position`",
                help=(
                    """write `in: 'rack_1.slot("A1")'`, or `frame: table` with `position: [0.1 m, 0 m, 0
                    m]`""",
                ),
            )
        )
        return None
    if model.in_ is None:
        assert model.frame is not None
        where = root.span_of(*path, "frame")
        return Prior("", "", model.frame, pose(model.position, model.rpy), model.confidence, where)
    where = root.span_of(*path, "in")
    place = named_place(model.in_, where, found)
    if place is None:
        return None
    holder, kind, key = place
    yaw = vec3(model.rpy)[2] if model.rpy else 0.0
    turned = Pose.from_rpy((0.0, 0.0, 0.0), (0.0, 0.0, math.remainder(yaw, math.tau)))
    return Prior(holder, key, "", turned, model.confidence, where, kind)
