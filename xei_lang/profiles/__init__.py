"""Profiles: the lab, its geometry and the robot's skills as data, read with positions and checked before use."""
