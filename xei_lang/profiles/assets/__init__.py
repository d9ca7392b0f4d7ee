"""Meshes and point clouds of objects: reading their files, and the size that they give an object."""
