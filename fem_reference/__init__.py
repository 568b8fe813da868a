"""Explicit finite-element reference for axisymmetric impacts of spheres on a plate.

The package meshes two spheres and a plate (gmsh), assembles stiffness and mass once
(dolfinx), steps with central differences and kinematic contact (compiled loop) and writes
the result as a folder. It is run as ``python3 -m fem_reference``. All quantities are SI.
"""

import os

from .common.parent import launched

# How often a thread of the loop looks for the others before it sleeps, read by OpenMP where it is
# loaded. By default it looks for milliseconds: where other programs want the processor, that is
# their time lost, and that of the thread it waits for.
os.environ.setdefault("GOMP_SPINCOUNT", "1000")

# Matrices are too small for threads of BLAS, whose waiting takes the processor from other programs.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# UCX, below MPICH, would take the signal of a closed terminal for itself.
os.environ.setdefault("UCX_DEBUG_SIGNO", "0")

# Open MPI starts a daemon beside a single process, and keeps a folder for it that a killed one
# leaves behind; nobody else joins such a process.
if not launched():
    os.environ.setdefault("OMPI_MCA_ess_singleton_isolated", "1")
    os.environ.setdefault("OMPI_MCA_orte_create_session_dirs", "0")
