"""Scenes of kind plate-impact: a sphere strikes a plate that a second sphere touches."""
