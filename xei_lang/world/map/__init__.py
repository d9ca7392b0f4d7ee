"""The map that the base drives by: reading, building, and what of a deployment it speaks against."""
