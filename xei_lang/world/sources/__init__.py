"""Who may say where things are: what a source of the world hands over, and how sources are merged."""

from xei_lang.world.sources.observation import Observation, Observations, WorldSource

__all__ = ["Observation", "Observations", "WorldSource"]
