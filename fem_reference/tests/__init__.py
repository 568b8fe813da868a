"""Tests of the reference, by subject."""
