"""What every kind of impact has: run, ending, history, series of meshes, result, commands."""
