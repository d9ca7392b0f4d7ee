"""Carries out a timed plan goal by goal, checks before each, and leaves a trace of every handoff."""
