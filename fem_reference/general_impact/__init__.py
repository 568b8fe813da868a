"""The kind impact: a body strikes a body from a file, a plate, a wall or another body."""
