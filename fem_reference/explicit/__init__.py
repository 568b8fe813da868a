"""Explicit time integration: kernel, loop, levels, contact, supervision, checkpoints."""
