"""From motion goals to timed, verified trajectories."""
