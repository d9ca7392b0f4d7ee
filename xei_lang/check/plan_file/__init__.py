"""A SkillPlan that came from elsewhere, held against the skill bank as if it were a protocol."""

from __future__ import annotations

from xei_lang.check.plan_file.check import PlanText, check_plan, read_plan_text

__all__ = ["PlanText", "check_plan", "read_plan_text"]
