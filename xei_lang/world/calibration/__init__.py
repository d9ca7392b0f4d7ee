"""Transforms measured from recordings: where a camera is mounted on the robot."""
