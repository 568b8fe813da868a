"""Mesh and stress of an axisymmetric solution as .vtu."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import meshio
import numpy as np

from ..axisymmetric.elasticity import STRESS_COMPONENTS, cell_stress, von_mises
from ..axisymmetric.system import System
from ..common.arrays import Floats
from .axisymmetric_run import Snapshot
from .meshing import ImpactMesh
from .scene import Scene


def _bodies(mesh: ImpactMesh) -> tuple[Floats, np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """Points (n, 3), quads (m, 4) and body number (m,) of all bodies; z is the second axis."""
    points, quads, body = [], [], []
    offset = 0
    for number, part in enumerate((mesh.outer, mesh.plate, mesh.inner)):
        points.append(np.column_stack([part.points, np.zeros(part.points.shape[0])]))
        quads.append(part.quads + offset)
        body.append(np.full(part.quads.shape[0], number, dtype=np.int32))
        offset += part.points.shape[0]
    return np.vstack(points), np.vstack(quads).astype(np.int32), np.concatenate(body)


def write_mesh(path: Path, mesh: ImpactMesh) -> None:
    """All bodies as one uncompressed .vtu; x is r, y is z.

    Cell data "body": 0 outer, 1 plate, 2 inner.
    """
    points, quads, body = _bodies(mesh)
    grid = meshio.Mesh(points, [("quad", quads)], cell_data={"body": [body]})
    meshio.vtu.write(path, grid, binary=True, compression=None)


def write_stress(
    path: Path, scene: Scene, mesh: ImpactMesh, system: System, snapshot: Snapshot
) -> None:
    """Displacement (nodes) and stress (elements' midpoints) of one instant as .vtu."""
    points, quads, body = _bodies(mesh)
    parts = (mesh.outer, mesh.plate, mesh.inner)
    materials = (scene.outer.material, scene.plate.material, scene.inner.material)
    displacement, stress = [], []
    for part, material, numbers in zip(parts, materials, system.numbers, strict=True):
        local = snapshot.displacement[numbers]
        displacement.append(np.column_stack([local, np.zeros(local.shape[0])]))
        stress.append(cell_stress(part, material, local))
    stresses = np.vstack(stress)
    cell_data = {"body": [body], "von_mises": [von_mises(stresses)]}
    for name, column in zip(STRESS_COMPONENTS, stresses.T, strict=True):
        cell_data[name] = [column]
    grid = meshio.Mesh(
        points,
        [("quad", quads)],
        point_data={"displacement": np.vstack(displacement)},
        cell_data=cell_data,
        field_data={},
    )
    meshio.vtu.write(path, grid, binary=True, compression=None)
