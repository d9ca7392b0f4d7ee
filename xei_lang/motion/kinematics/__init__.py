"""Inverse kinematics of one arm: closed form where the arm allows it, numerical and named so where not."""

from __future__ import annotations

from xei_lang.motion.kinematics.solver import Solutions, Solver, arm_solver

__all__ = ["Solutions", "Solver", "arm_solver"]
