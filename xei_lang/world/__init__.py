"""The world: frames, places, and where everything is believed to be before the robot looks."""
