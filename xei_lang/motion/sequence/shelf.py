"""The collision scenes that were asked for last, by their content: a compiled scene is dear in time and in
memory.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field

from xei_lang.motion.collision import CollisionScene

CAPACITY = 8
"""Enough for the scenes of neighbouring chains; each takes about 13 MB on the bench."""


@dataclass(frozen=True, slots=True)
class SceneShelf:
    """At most `CAPACITY` scenes, the one not asked for longest dropped first. What it holds never changes a
    result.
    """

    _scenes: dict[Hashable, CollisionScene] = field(default_factory=dict[Hashable, CollisionScene])

    def scene(self, content: Hashable, make: Callable[[], CollisionScene]) -> CollisionScene:
        """The scene of this content, made now if it is not on the shelf."""
        found = self._scenes.pop(content, None) or make()
        self._scenes[content] = found
        if len(self._scenes) > CAPACITY:
            del self._scenes[next(iter(self._scenes))]
        return found
