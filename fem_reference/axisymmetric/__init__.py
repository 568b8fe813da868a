"""Axisymmetric bodies: meshes of quadrilaterals, elements with incompatible modes, eigenmodes."""
