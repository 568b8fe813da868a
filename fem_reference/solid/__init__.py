"""Three-dimensional explicit reference: tetrahedra, rigid bodies, contact, MPI, checkpoints."""
