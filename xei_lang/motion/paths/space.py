"""The space that a path may use, as planners see it: bounds, speeds, and what is free."""

from __future__ import annotations

from typing import Protocol

from xei_lang.motion.paths.joint_path import Array


class FreeSpace(Protocol):
    """What a path may use: `lower`, `upper` and `speed` are arrays (n,) over the moving joints."""

    @property
    def joints(self) -> tuple[str, ...]:
        """The names of the moving joints."""
        ...

    @property
    def lower(self) -> Array:
        """Lower ends of their ranges (n,)."""
        ...

    @property
    def upper(self) -> Array:
        """Upper ends of their ranges (n,)."""
        ...

    @property
    def speed(self) -> Array:
        """Their velocity limits (n,)."""
        ...

    def is_free(self, q: Array) -> bool:
        """Whether the configuration (n,) touches nothing it may not touch."""
        ...

    def edge_is_free(self, q_start: Array, q_end: Array) -> bool:
        """Whether every configuration on the straight line is free."""
        ...

    def contact(self, q: Array) -> tuple[str, str] | None:
        """The two bodies that touch at a configuration, or None."""
        ...
