"""Profiles: the lab, its geometry and the robot's skills as data, read with places, checked before use."""
