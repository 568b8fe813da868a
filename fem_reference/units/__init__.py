"""Functional Mock-up Units of others as models of a scene, run by FMPy."""
