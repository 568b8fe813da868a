"""Eigenfrequencies of the plate."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

from ..common.arrays import Floats
from ..common.bodies import Plate
from ..common.errors import SolverError
from ..explicit.damping import Modes
from .mesh import BodyMesh, face_nodes
from .system import AxisymmetricSystem, plate_constraints


def first_frequency(system: AxisymmetricSystem) -> float:
    """Lowest elastic eigenfrequency of the plate of the time loop (lumped mass), Hz."""
    rows = system.body(1)
    inverse = system.inverse_mass[rows]
    free = np.flatnonzero(inverse > 0.0)
    stiffness = system.stiffness[rows, rows].tocsc()[free][:, free]
    mass = scipy.sparse.diags(1.0 / inverse[free]).tocsc()
    # A shift below zero keeps the factorisation regular for a free plate.
    scale = float(np.median(stiffness.diagonal() * inverse[free]))
    count = 2 if system.supports.size == 0 else 1
    values = scipy.sparse.linalg.eigsh(
        stiffness, k=count, M=mass, sigma=-1e-9 * scale, which="LM", return_eigenvectors=False
    )
    return math.sqrt(float(values.max())) / (2.0 * math.pi)


def elastic_modes(system: AxisymmetricSystem, count: int) -> Modes:
    """Lowest elastic modes of the plate of the time loop, rigid motion left out."""
    rows = system.body(1)
    inverse = system.inverse_mass[rows]
    free = np.flatnonzero(inverse > 0.0)
    stiffness = system.stiffness[rows, rows].tocsc()[free][:, free]
    mass = scipy.sparse.diags(1.0 / inverse[free]).tocsc()
    scale = float(np.median(stiffness.diagonal() * inverse[free]))
    rigid = 1 if system.supports.size == 0 else 0
    count = min(count, free.size // 4)
    start = np.random.default_rng(2).standard_normal(free.size)
    values, vectors = scipy.sparse.linalg.eigsh(
        stiffness, k=count + rigid, M=mass, sigma=-1e-9 * scale, which="LM", v0=start
    )
    order = np.argsort(values)[rigid:]
    shapes = np.zeros((inverse.size, order.size))
    shapes[free] = vectors[:, order]
    return Modes(np.sqrt(values[order]), shapes)


def modes_up_to(system: AxisymmetricSystem, frequency: float) -> Modes:
    """The same, all up to an angular frequency (rad/s) and one more."""
    count = 16
    modes = elastic_modes(system, count)
    while modes.frequencies[-1] < frequency and modes.frequencies.size == count:
        count *= 2
        modes = elastic_modes(system, count)
    retained = int(np.searchsorted(modes.frequencies, frequency)) + 1
    return Modes(modes.frequencies[:retained], modes.shapes[:, :retained])


@dataclass(frozen=True)
class PlateMode:
    """One axisymmetric eigenmode of the plate."""

    frequency: float
    """Hz"""
    longitudinal: bool
    """Axial displacement antisymmetric about the midplane."""
    face: tuple[Floats, Floats]
    """Radii (m) of the inner face's nodes, and their axial displacement with unit modal mass,
    1/sqrt(kg)."""


def plate_modes(
    plate: Plate, mesh: BodyMesh, count: int, degree: int = 2, rigid: bool = False
) -> list[PlateMode]:
    """Lowest eigenmodes of the continuum plate, consistent mass, elements of ``degree``.

    Shift-invert Krylov-Schur by SLEPc. The rigid motion of a free plate is left out unless
    ``rigid``.

    Raises:
        SolverError: SLEPc found fewer modes.
    """
    from slepc4py import SLEPc

    from ..common.fenicsx import petsc_matrix
    from .elasticity import assemble_consistent

    stiffness, mass, points = assemble_consistent(mesh, plate.material, degree)
    nodes = BodyMesh(mesh.name, points, mesh.quads)
    # Snap what tabulating the points may have rounded.
    nodes.points[np.abs(points[:, 0]) < 1e-12 * plate.radius, 0] = 0.0
    keep = np.setdiff1d(np.arange(2 * points.shape[0]), plate_constraints(plate, nodes))
    reduced_stiffness = stiffness[keep][:, keep]
    reduced_mass = mass[keep][:, keep]
    extra = 0 if rigid or plate.edge != "free" else 1
    # The shift lies below the spectrum, by about the first eigenvalue of a supported plate.
    first = 4.977 / plate.radius**2 * math.sqrt(plate.bending_stiffness / plate.surface_density)
    solver = SLEPc.EPS().create()
    solver.setOperators(petsc_matrix(reduced_stiffness), petsc_matrix(reduced_mass))
    solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTarget(-(first**2))
    solver.getST().setType("sinvert")
    solver.setDimensions(count + extra)
    solver.setTolerances(1e-10)
    solver.solve()
    if solver.getConverged() < count + extra:
        raise SolverError(
            f"SLEPc found {solver.getConverged()} of {count + extra} plate modes requested"
        )
    mirror = _mirror_nodes(points)
    face = face_nodes(points, -0.5 * plate.thickness)
    vector = solver.getOperators()[0].createVecRight()
    modes = []
    for index in range(extra, count + extra):
        eigenvalue = solver.getEigenpair(index, vector).real
        shape = np.zeros(2 * points.shape[0])
        shape[keep] = vector.array.real
        shape /= math.sqrt(shape @ (mass @ shape))
        axial = shape[1::2]
        weight = np.asarray(mass.sum(axis=1)).ravel()[1::2]
        # Parity: +1 symmetric (bending), -1 antisymmetric, weighted by the nodes' mass.
        parity = float(np.sum(weight * axial * axial[mirror]))
        frequency = math.sqrt(max(eigenvalue, 0.0)) / (2.0 * math.pi)
        modes.append(PlateMode(frequency, parity < 0.0, (points[face, 0], axial[face])))
    solver.destroy()
    return modes


def _mirror_nodes(points: Floats) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """For each node the node at -z."""
    from scipy.spatial import cKDTree

    distance, index = cKDTree(points).query(points * np.array([1.0, -1.0]))
    if distance.max() > 1e-6 * np.ptp(points[:, 1]):
        raise SolverError("the plate's mesh is not symmetric about its midplane")
    return np.asarray(index, dtype=np.intp)
