"""A grounded world for people: a table, a top view, and all that is known of one object."""
