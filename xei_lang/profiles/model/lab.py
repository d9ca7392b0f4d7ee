"""What a usage profile and an object registry say: the things in the lab and the room."""

from __future__ import annotations

from typing import Literal

from xei_lang.diagnostics import Span
from xei_lang.ir.geometry import Pose, Primitive, Shape, Vec3
from xei_lang.quantity import Quantity
from xei_lang.record import Record, record


@record
class Liquid(Record):
    """A container's volumes in m3 and its inner diameter in m."""

    capacity_m3: float
    dead_volume_m3: float
    inner_diameter_m: float


@record
class FiniteState(Record):
    """A declared state of an object, its values and the value it starts with."""

    name: str
    values: tuple[str, ...]
    initial: str
    span: Span


@record
class SlotGrid(Record):
    """A grid of slots: `rows[i]` and column j (from 1) name the slot `A1`; its mouth stands at `origin_m +
    (j-1) * pitch_m[0] * x + i * pitch_m[1] * y` in the object's frame, its axis along z.

    `origin_m` is given from the corner of the bounding box with the smallest x and y, z from the bottom.
    """

    rows: tuple[str, ...]
    columns: int
    pitch_m: tuple[float, float]
    origin_m: Vec3
    bore_m: float
    chamfer_m: float
    depth_m: float
    accepts: tuple[str, ...]
    span: Span


@record
class Spot(Record):
    """A named place on a surface: where the bottom centre of an object stands, in the surface's frame. It
    takes objects of one of the roles `accepts`; any, where that is empty.
    """

    name: str
    T_object_spot: Pose
    span: Span
    accepts: tuple[str, ...] = ()


@record
class Element(Record):
    """An element of a touch screen: centre and size on the screen's plane, metres, to the right and up from
    the lower left corner of its face.
    """

    name: str
    center_m: tuple[float, float]
    size_m: tuple[float, float]
    span: Span

    @property
    def spans_m(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """From where to where it is to the right, and up."""
        (x, y), (width, height) = self.center_m, self.size_m
        return (x - width / 2, x + width / 2), (y - height / 2, y + height / 2)

    def is_on(self, width_m: float, height_m: float) -> bool:
        """Whether all of it is on a face of this size, to a micrometre."""
        sides = zip(self.spans_m, (width_m, height_m), strict=True)
        return all(low >= -1e-6 and high <= edge + 1e-6 for (low, high), edge in sides)


@record
class Tip(Record):
    """The tips that a pipette takes: length and widest outer diameter of one, how deep the nose sits in it
    (m), and what it holds (m3).

    The pipette's own frame is where the end of a tip on it is.
    """

    length_m: float
    diameter_m: float
    seat_m: float
    capacity_m3: float
    span: Span


@record
class Thread(Record):
    """The thread of a cap: the place that it closes (`on_object.spot("on_key")`), how far it rises in a whole
    turn (m), in how many turns it comes off, and where it lies while its vessel is open.
    """

    on_object: str
    on_key: str
    lead_m: float
    turns: float
    rest_object: str
    rest_key: str
    span: Span


@record
class Prior(Record):
    """Where an object is believed to be: in a place of another object, or (`in_object` empty) at a pose in a
    frame.
    """

    in_object: str
    in_key: str
    frame: str
    T_frame_object: Pose
    confidence: float
    span: Span
    in_kind: Literal["", "slot", "spot"] = ""


@record
class OperationDefault(Record):
    """An operation parameter that a profile states for an object or a skill (`approach`, `width`,
    `standoff`).
    """

    name: str
    value: Quantity | str
    span: Span


@record
class Asset(Record):
    """A mesh or a point cloud (`what`) that was read: its file's hash and unit, where it is in the object's
    frame, and the edges of its bounding box there, m.
    """

    what: Literal["mesh", "point_cloud"]
    path: str
    sha256: str
    units: str
    T_object_file: Pose
    size_m: Vec3
    span: Span


@record
class LabObject(Record):
    """An object of the usage profile or a system object of the registry. Its frame is at its bottom centre, z
    up.

    `skills` is all that may be done with it, unless `skills_span` is None: then the profile does not say, and
    anything may. `assets` are the files that it names, `models` those that were read; `computed_from` says
    what its size was computed from, and is empty where the profile states it.
    """

    name: str
    aliases: tuple[str, ...]
    roles: tuple[str, ...]
    shape: Shape
    geometry: tuple[Primitive, ...]
    size_m: Vec3
    mass_kg: float
    skills: tuple[str, ...]
    states: tuple[FiniteState, ...]
    liquid: Liquid | None
    grasp: tuple[OperationDefault, ...]
    slots: SlotGrid | None
    spots: tuple[Spot, ...]
    elements: tuple[Element, ...]
    prior: Prior | None
    assets: tuple[tuple[str, str | None], ...]
    system: bool
    span: Span
    tip: Tip | None = None
    thread: Thread | None = None
    models: tuple[Asset, ...] = ()
    computed_from: str = ""
    skills_span: Span | None = None
    mass_span: Span | None = None
