"""CalculiX as a second program: axisymmetric bodies as wedges, implicit steps, penalty contact."""
