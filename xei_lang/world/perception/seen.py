"""What came of asking where objects are: what is believed, and what is not, with reasons."""

from __future__ import annotations

from dataclasses import dataclass

from xei_lang.diagnostics import Diagnostics
from xei_lang.world.perception.service_fault import PoseRefused
from xei_lang.world.sources.observation import Observations


@dataclass(frozen=True, slots=True)
class Seen:
    """The objects that are believed, those that are not, and the camera that saw them, if it is known."""

    observations: Observations
    refused: tuple[PoseRefused, ...] = ()
    camera: str = ""

    @property
    def diagnostics(self) -> Diagnostics:
        """The refusals as they are shown."""
        return tuple(item.diagnostic() for item in self.refused)
