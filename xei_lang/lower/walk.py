"""The geometric state while lowering: where the base and every object stand and what each hand holds.

A `Scene` is a value; each event (attach, detach, drive) gives the next one. Poses are kept in `world`, so
that a drive only changes the base and what the base does not carry is seen from its new place.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from xei_lang.diagnostics import Label, Span
from xei_lang.ir.families import Family
from xei_lang.ir.geometry import Pose
from xei_lang.ir.goals import Epoch
from xei_lang.ir.skill_plan import Side
from xei_lang.ir.world import Drive, World, WorldObject
from xei_lang.profiles.model import Profile

_REST_TOLERANCE_M = 0.01


@dataclass(frozen=True, slots=True)
class Standing:
    """An object that no hand holds: its pose, the place it stands in (or empty), what carries it, and since
    when.

    What is `fastened` rides on what carries it: a hand that takes that one takes both.
    """

    object: str
    T_world_object: Pose
    place: str
    support: str
    since: Label | None
    fastened: bool = False


@dataclass(frozen=True, slots=True)
class Rider:
    """What rides on an object that a hand holds: where it sits there, which never changes, and what it is
    once that one stands again.
    """

    T_carrier_rider: Pose
    standing: Standing


@dataclass(frozen=True, slots=True)
class Held:
    """An object in a hand: the family it was grasped with and where it stood then, in `world` and as the base
    saw it.

    `grasp_width_m` is how wide it is between the jaws, `sunk_m` how deep it stood in its slot. `touching`
    names the support that it has not left yet, or reaches at the end of a linear move; empty in the air.
    `entered` names what it has gone into. `T_world_now` is where it is held still in the air, for what is
    worked on it there.
    """

    object: str
    family: Family
    T_world_grasped: Pose
    T_base_grasped: Pose
    standoff_m: float
    grasp_width_m: float
    sunk_m: float
    touching: str
    since: Label
    entered: tuple[str, ...] = ()
    T_world_now: Pose | None = None


@dataclass(frozen=True, slots=True)
class Scene:
    """Where everything is at one point of the plan. `reached` names the object that a hand stands around
    without holding it; `drives` are the ways between stations that a map is known to leave; `riding` is what
    rides on objects in hands, by name.
    """

    epoch: Epoch
    provisional: bool
    standing: Mapping[str, Standing]
    held: Mapping[Side, Held]
    reached: Mapping[Side, str]
    drives: tuple[Drive, ...] = ()
    riding: Mapping[str, Rider] = field(default_factory=dict[str, Rider])

    @staticmethod
    def of(world: World, profile: Profile) -> Scene:
        """The scene before anything moves, at the station where the robot stands."""
        standing = {item.name: _standing(item, world, profile) for item in world.objects}
        epoch = Epoch(0, world.robot.station, world.robot.T_world_base)
        return Scene(epoch, False, standing, {}, {}, world.drives)

    def T_base_object(self, name: str) -> Pose:
        """Pose of a standing object in the base frame of this epoch. Raises KeyError for one in a hand."""
        return self.in_base(self.standing[name].T_world_object)

    def T_world_of(self, name: str) -> Pose:
        """Pose of an object that stands, is held still, or rides on such a one. KeyError for any other."""
        if name in self.standing:
            return self.standing[name].T_world_object
        if name in self.riding:
            rider = self.riding[name]
            return self.T_world_of(rider.standing.support) @ rider.T_carrier_rider
        held = next((item for item in self.held.values() if item.object == name), None)
        if held is None:
            raise KeyError(name)
        return held.T_world_now or held.T_world_grasped

    def in_base(self, T_world_x: Pose) -> Pose:
        """A pose of `world` in the base frame of this epoch."""
        return self.epoch.T_world_base.inverse() @ T_world_x

    def holder(self, name: str) -> Side | None:
        """The hand that holds the object, or None."""
        return next((side for side, held in self.held.items() if held.object == name), None)

    def holders(self, name: str) -> tuple[Side, ...]:
        """The hands that hold the object: two while it is handed over."""
        return tuple(side for side, held in self.held.items() if held.object == name)

    def carried_by(self, name: str) -> tuple[Standing, ...]:
        """What stands in or on the object and would stay behind or fall if that were lifted."""
        return tuple(item for item in self.standing.values() if item.support == name and not item.fastened)

    def carrier_of(self, name: str) -> str:
        """The object that this one is fastened on, wherever they are; empty for none."""
        rider = self.riding.get(name)
        found = rider.standing if rider else self.standing.get(name)
        return found.support if found and found.fastened else ""

    def riders_of(self, name: str) -> tuple[str, ...]:
        """What is fastened on the object, and on that, carriers first."""
        own = [item.object for item in self.standing.values() if item.fastened and item.support == name]
        own += [other for other in self.riding if self.carrier_of(other) == name]
        return tuple(found for other in own for found in (other, *self.riders_of(other)))

    def occupant(self, place: str) -> Standing | None:
        """What stands in a place, or None."""
        return next((item for item in self.standing.values() if item.place == place), None)

    def attach(self, side: Side, held: Held) -> Scene:
        """The hand takes the object away from where it stands, with what rides on it; that one rides on
        nothing from then on. What another hand stands around but does not take, it goes on standing around.
        """
        taken = (held.object, *self.riders_of(held.object))
        standing = {name: item for name, item in self.standing.items() if name not in taken}
        riding = {name: item for name, item in self.riding.items() if name != held.object}
        riding |= {name: self._rider(self.standing[name]) for name in taken[1:] if name in self.standing}
        reached = {key: name for key, name in self.reached.items() if key != side and name not in taken}
        return replace(
            self, standing=standing, held={**self.held, side: held}, reached=reached, riding=riding
        )

    def _rider(self, rider: Standing) -> Rider:
        return Rider(self.standing[rider.support].T_world_object.inverse() @ rider.T_world_object, rider)

    def detach(self, side: Side, standing: Standing) -> Scene:
        """The hand leaves its object standing, and what rides on it."""
        held = {key: item for key, item in self.held.items() if key != side}
        stands = {**self.standing, standing.object: standing}
        for name in self.riders_of(standing.object):
            rider = self.riding[name]
            T_world_rider = stands[rider.standing.support].T_world_object @ rider.T_carrier_rider
            stands[name] = replace(rider.standing, T_world_object=T_world_rider)
        riding = {name: item for name, item in self.riding.items() if name not in stands}
        return replace(self, held=held, standing=stands, riding=riding)

    def fasten(self, side: Side, rider: Standing) -> Scene:
        """The hand leaves its object on one that stands or is held, on which it rides from then on."""
        held = {key: item for key, item in self.held.items() if key != side}
        if rider.support in self.standing:
            return replace(self, held=held, standing={**self.standing, rider.object: rider})
        there = self.T_world_of(rider.support).inverse() @ rider.T_world_object
        return replace(self, held=held, riding={**self.riding, rider.object: Rider(there, rider)})

    def hold_at(self, side: Side, T_world_object: Pose | None) -> Scene:
        """What the hand holds is there now, and held still (None: on its way)."""
        if side not in self.held:
            return self
        held = replace(self.held[side], T_world_now=T_world_object)
        return replace(self, held={**self.held, side: held})

    def let_go(self, side: Side) -> Scene:
        """The hand leaves its object to the other one, which holds it too."""
        return replace(self, held={key: item for key, item in self.held.items() if key != side})

    def touch(self, side: Side, support: str, entered: tuple[str, ...] = ()) -> Scene:
        """What the hand holds now touches this support (empty: nothing) and stands in what it has entered."""
        if side not in self.held:
            return self
        held = replace(self.held[side], touching=support, entered=entered)
        return replace(self, held={**self.held, side: held})

    def reach(self, side: Side, name: str) -> Scene:
        """The open hand now stands around this object (empty: around none)."""
        others = {key: item for key, item in self.reached.items() if key != side}
        return replace(self, reached={**others, side: name} if name else others)

    def way_to(self, station: str) -> Drive | None:
        """The base's way from where it stands to a station by the map, or None where no map says one."""
        ends = (self.epoch.station, station)
        return next((one for one in self.drives if (one.start, one.goal) == ends), None)

    def drive(self, station: str, T_world_base: Pose) -> Scene:
        """The base stands elsewhere: a new epoch, not yet grounded; what the hands hold has come along."""
        epoch = Epoch(self.epoch.index + 1, station, T_world_base)
        return replace(self, epoch=epoch, provisional=False)

    def perceive(self) -> Scene:
        """From here on, goals of this epoch are provisional."""
        return replace(self, provisional=True)

    def forget(self, names: tuple[str, ...]) -> Scene:
        """Drop objects whose whereabouts are not known any more, so that one mistake is reported once."""
        lost = {rider for name in names for rider in (name, *self.riders_of(name))}
        standing = {name: item for name, item in self.standing.items() if name not in lost}
        held = {side: item for side, item in self.held.items() if item.object not in lost}
        riding = {name: item for name, item in self.riding.items() if name not in lost}
        return replace(self, standing=standing, held=held, reached={}, riding=riding)


def _standing(item: WorldObject, world: World, profile: Profile) -> Standing:
    pose = world.T_world_object(item.name)
    support = item.fastened_to or item.place.partition(".")[0] or _support(item.name, pose, world)
    since = _prior_label(item.name, profile)
    return Standing(item.name, pose, item.place, support, since, bool(item.fastened_to))


def _prior_label(name: str, profile: Profile) -> Label | None:
    known = profile.object(name)
    if known is None:
        return None
    span: Span = known.prior.span if known.prior else known.span
    return Label(span, f"`{name}` stands here from the start")


def _support(name: str, T_world_object: Pose, world: World) -> str:
    """The object whose top the bottom of this one rests on, or empty."""
    for other in world.objects:
        if other.name == name:
            continue
        x, y, z = world.T_world_object(other.name).inverse().apply(T_world_object.position_m)
        inside = abs(x) <= other.size_m[0] / 2 and abs(y) <= other.size_m[1] / 2
        if inside and abs(z - other.size_m[2]) <= _REST_TOLERANCE_M:
            return other.name
    return ""
