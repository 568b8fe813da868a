"""Explicit finite-element reference for axisymmetric impacts of spheres on a plate.

The package meshes two spheres and a plate (gmsh), assembles stiffness and mass once
(dolfinx), steps with central differences and kinematic contact (compiled loop) and writes
the result as a folder. It is run as ``python3 -m fem_reference``. All quantities are SI.
"""
