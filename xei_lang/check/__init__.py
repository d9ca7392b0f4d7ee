"""From a syntax tree and a profile to a SkillPlan: names, types, roles, binding, expansion and facts.

Imports neither numpy, networkx nor pydantic: checking must start at once.
"""

from __future__ import annotations

from xei_lang.check.binding import CheckOptions
from xei_lang.check.module import check_module, is_library, profile_name

__all__ = ["CheckOptions", "check_module", "is_library", "profile_name"]
