"""Meshes and contours of other programs as rows of a LAGAMINE deck; nothing here knows the solver, only its cards."""
