"""A pose service: HTTP around a backend that estimates poses from pictures."""
