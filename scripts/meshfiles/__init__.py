"""Meshes of other programs: readers, one structure for all of them, and the writer of gmsh's format 4.1."""
