"""Every code that a diagnostic may carry: one line each, in the files of this folder.

Each file says which ranges it holds; `RANGES` says what they are about. A code is added to its range there,
and never reused for something else.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from xei_lang.diagnostics.catalogue import motion, profiles, protocols, runs
from xei_lang.diagnostics.catalogue.entry import Entry

__all__ = ["CATALOGUE", "RANGES", "Entry"]

CATALOGUE: Mapping[str, Entry] = MappingProxyType(
    protocols.ENTRIES | profiles.ENTRIES | motion.ENTRIES | runs.ENTRIES
)

RANGES: Mapping[str, str] = MappingProxyType(
    {
        "XEI01": "files and syntax",
        "XEI02": "names and binding",
        "XEI03": "types, units and arguments",
        "XEI04": "state and time",
        "XEI05": "warnings",
        "XEI06": "profiles and world",
        "XEI07": "lowering and operation parameters",
        "XEI08": "motion",
        "XEI09": "running, bundles and traces",
    }
)
"""What the codes of a range are about, by their first five characters."""
