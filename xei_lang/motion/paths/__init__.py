"""Collision-free geometric paths in joint space."""
