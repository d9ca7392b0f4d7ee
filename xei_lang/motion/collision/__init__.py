"""Collision checking of the robot, what it holds and what stands around it, with coal through pinocchio."""

from __future__ import annotations

from xei_lang.motion.collision.bodies import AttachedBody, StaticBody
from xei_lang.motion.collision.scene import CollisionScene, Contact, collision_scene

__all__ = ["AttachedBody", "CollisionScene", "Contact", "StaticBody", "collision_scene"]
