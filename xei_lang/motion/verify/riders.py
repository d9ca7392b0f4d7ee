"""What is fastened on what while a plan is walked through: a cap goes where its bottle goes."""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping
from dataclasses import dataclass

from xei_lang.ir.geometry import Pose
from xei_lang.ir.world import World


@dataclass(frozen=True, slots=True)
class Ride:
    """The object that another one rides on, and the rider's pose in its frame."""

    on: str
    pose: Pose


class Riders:
    """The rides of the moment, by the rider's name. Poses are in `world`, by name, and kept by the caller."""

    def __init__(self, world: World, T_world: Mapping[str, Pose]) -> None:
        self.rides: dict[str, Ride] = {}
        for item in world.objects:
            if item.fastened_to:
                self.fasten(item.name, item.fastened_to, T_world)

    def fasten(self, name: str, on: str, T_world: Mapping[str, Pose]) -> None:
        """From here on it rides there, as it stands. What is not in the world, or would ride on itself,
        rides nowhere.
        """
        if name in T_world and on in T_world and name not in (on, *self.below(on)):
            self.rides[name] = Ride(on, T_world[on].inverse() @ T_world[name])

    def loosen(self, name: str) -> None:
        """It rides on nothing any more."""
        self.rides.pop(name, None)

    def below(self, name: str) -> tuple[str, ...]:
        """What an object rides on, what that rides on, and so on to what stands or is held by itself."""
        found: list[str] = []
        while name in self.rides:
            name = self.rides[name].on
            found.append(name)
        return tuple(found)

    def above(self, name: str) -> tuple[str, ...]:
        """All that rides on an object, what is nearer to it first."""
        depth = {rider: self.below(rider).index(name) for rider in self.rides if name in self.below(rider)}
        return tuple(sorted(depth, key=lambda rider: (depth[rider], rider)))

    def pose_on(self, rider: str, name: str) -> Pose:
        """A rider's pose in the frame of an object below it."""
        pose = Pose()
        while rider != name:
            pose = self.rides[rider].pose @ pose
            rider = self.rides[rider].on
        return pose

    def follow(self, name: str, T_world: MutableMapping[str, Pose]) -> None:
        """Bring all that rides on an object to where that one is."""
        for rider in self.above(name):
            T_world[rider] = T_world[name] @ self.pose_on(rider, name)
