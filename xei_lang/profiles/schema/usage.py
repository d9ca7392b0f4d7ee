"""usage_profile.yaml: what is in the lab."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from xei_lang.profiles.schema.assets import AssetsModel, CloudShapeModel, MeshShapeModel
from xei_lang.profiles.schema.values import (
    AngleVector,
    Count,
    Distance,
    Fraction01,
    LengthPair,
    LengthVector,
    Mass,
    Model,
    Name,
    OperationValue,
    RowName,
    Size,
    SizePair,
    SizeVector,
    Text,
    Volume,
)

MOST_TURNS = 10.0
"""More than any screw cap has."""


class CylinderSize(Model):
    """A cylinder that stands on its bottom."""

    diameter: Size
    height: Size


class ShapeModel(Model):
    """Just one of: a box by its edges along x, y and z, or a cylinder."""

    box: SizeVector | None = None
    cylinder: CylinderSize | None = None


class ObjectShapeModel(ShapeModel):
    """Just one of: a box, a cylinder, or what is taken from a mesh or a point cloud."""

    mesh: MeshShapeModel | None = None
    point_cloud: CloudShapeModel | None = None


class PartModel(ShapeModel):
    """A collision primitive; `position` is its centre in the object's frame."""

    position: LengthVector | None = None
    rpy: AngleVector | None = None


class LiquidModel(Model):
    """What a container holds at most, and what it can never give back."""

    capacity: Volume
    dead_volume: Volume
    inner_diameter: Size


class StateModel(Model):
    """A state that an object can be in."""

    values: list[Name] = Field(min_length=1)
    initial: Name


class SlotsModel(Model):
    """A grid of slots; `origin` is the mouth of the first one from the corner with the smallest x and y, z
    from the bottom.
    """

    rows: list[RowName] = Field(min_length=1, max_length=100)
    columns: Count
    pitch: SizePair
    origin: LengthVector
    bore: Size
    chamfer: Distance
    depth: Size
    accepts: list[Name]


class SpotModel(Model):
    """A named place: where the bottom centre of an object stands, in this object's frame, and which roles it
    takes; any, where `accepts` is left out.
    """

    position: LengthVector
    rpy: AngleVector | None = None
    accepts: list[Name] = Field(default=[])


class ElementModel(Model):
    """An element of a touch screen, from the screen's bottom left corner: right and up."""

    center: LengthPair
    size: SizePair


class TipModel(Model):
    """The tips that a pipette takes: length and widest outer diameter of one, how deep the nose sits in it,
    and what it holds.
    """

    length: Size
    diameter: Size
    seat: Size
    capacity: Volume


class ThreadModel(Model):
    """The thread of a cap: the spot of the vessel that it closes, how far it rises in a whole turn, in how
    many turns it comes off, and the spot where it lies while the vessel is open. Right-handed: turned to
    the left, seen from above, it opens.
    """

    closes: Text
    lead: Size
    turns: Annotated[float, Field(gt=0.0, le=MOST_TURNS)]
    rest: Text


class PriorModel(Model):
    """Where an object should be: `in` a place such as `rack_1.slot("A1")`, or at a pose in a frame."""

    in_: str | None = Field(default=None, alias="in")
    frame: Name | None = None
    position: LengthVector | None = None
    rpy: AngleVector | None = None
    confidence: Fraction01


class ObjectModel(Model):
    """An object: its frame is at its bottom centre, z up."""

    aliases: list[Text] = Field(default=[])
    roles: list[Name] = Field(min_length=1)
    shape: ObjectShapeModel
    collision: list[PartModel] | None = None
    assets: AssetsModel = AssetsModel()
    mass: Mass | None = None
    liquid: LiquidModel | None = None
    states: dict[Name, StateModel] = Field(default={})
    skills: list[Name] | None = None
    grasp: dict[Name, OperationValue] = Field(default={})
    slots: SlotsModel | None = None
    spots: dict[Name, SpotModel] = Field(default={})
    elements: dict[Name, ElementModel] = Field(default={})
    tip: TipModel | None = None
    thread: ThreadModel | None = None
    prior: PriorModel | None = None


class LiquidKindModel(Model):
    """A liquid by its name in protocols."""

    hazards: list[Name] = Field(default=[])


class UsageProfile(Model):
    """What is in the lab: objects, their places, liquids and what must not meet."""

    version: Literal[1]
    objects: dict[Name, ObjectModel]
    liquids: dict[Name, LiquidKindModel] = Field(default={})
    incompatible: list[list[Name]] = Field(default=[])
