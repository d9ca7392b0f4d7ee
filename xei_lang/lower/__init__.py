"""Lowering: from skills to motion goals, by declarative templates and deterministic operation-parameter
planners.
"""

from __future__ import annotations

from xei_lang.lower.lower import lower
from xei_lang.lower.precision import imprecise_tasks

__all__ = ["imprecise_tasks", "lower"]
