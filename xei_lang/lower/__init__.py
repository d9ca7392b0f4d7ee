"""Lowering: from skills to motion goals, by declarative templates and deterministic operation-parameter
planners.
"""

from __future__ import annotations

from xei_lang.lower.lower import lower

__all__ = ["lower"]
