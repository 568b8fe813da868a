"""A sphere strikes a mass on a spring."""
