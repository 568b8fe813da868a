"""Solves a scene on a mesh that was made elsewhere: releases of FEniCSx, apart from gmsh's.

fixed_mesh make SCENE MESH          mesh at coarse resolution, kept as a file
fixed_mesh run SCENE MESH FOLDER    solve on it, FOLDER/summary.json with the quantities
"""

from __future__ import annotations

import json
import pickle
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from fem_reference.axisymmetric.modal import first_frequency as plate_frequency
from fem_reference.common.decode import read_document
from fem_reference.common.fenicsx import alone
from fem_reference.common.settings import RESOLUTIONS
from fem_reference.explicit.spectrum import first_frequency
from fem_reference.plate_impact.axisymmetric_motion import integrate_axisymmetric
from fem_reference.plate_impact.estimate import estimate_contact, shortest_wavelengths
from fem_reference.plate_impact.meshing import build_system, mesh_impact, mesh_settings
from fem_reference.plate_impact.motion import PLATE
from fem_reference.plate_impact.result import of_run
from fem_reference.plate_impact.scene import Scene, parse_scene
from fem_reference.plate_impact.solid_model import plate_model
from fem_reference.plate_impact.solid_motion import integrate_solid
from fem_reference.seal_seat.meshing import seat_mesh
from fem_reference.seal_seat.model import seat_model
from fem_reference.seal_seat.run import integrate as integrate_seat
from fem_reference.seal_seat.scene import SeatScene, parse_seat_scene
from fem_reference.seal_seat.solve import quantities as seat_quantities
from fem_reference.solid.system import make_loop


def make(scene: Scene | SeatScene) -> Any:
    """The mesh, and for plates the estimate it was made for."""
    factor = RESOLUTIONS["coarse"]
    if isinstance(scene, SeatScene):
        return seat_model(scene, seat_mesh(scene, factor), None), None
    estimate = estimate_contact(scene)
    if scene.geometry == "solid":
        waves = shortest_wavelengths(scene, estimate.duration)
        return plate_model(scene, estimate, waves, factor), estimate
    settings = mesh_settings(scene, estimate.outer_radius, estimate.inner_radius, factor)
    return mesh_impact(scene, settings), estimate


def run(scene: Scene | SeatScene, mesh: Any, estimate: Any) -> tuple[dict[str, float], int]:
    """Quantities, and the number of nodes."""
    if isinstance(scene, SeatScene):
        loop = make_loop(mesh.model, alone())
        seat: Any = SimpleNamespace(run=integrate_seat(loop, mesh, scene), loop=loop, seat=mesh)
        return seat_quantities(scene, seat), loop.system.mass.size
    if scene.geometry == "solid":
        loop = make_loop(mesh.model, alone())
        found = of_run(scene, integrate_solid(loop, mesh, scene, estimate.duration))
        frequency = first_frequency(loop, mesh.elastic[PLATE])
        return {**found, "first_frequency": frequency}, loop.system.mass.size
    system = build_system(scene, mesh)
    run, _ = integrate_axisymmetric(system, scene, estimate.duration, end_time=scene.end_time)
    frequency = plate_frequency(system)
    return {**of_run(scene, run), "first_frequency": frequency}, int(system.mass.size)


def main(task: str, scene_path: Path, mesh_path: Path, *folder: str) -> None:
    """Do one of the two tasks."""
    document = read_document(scene_path)
    seat = document["kind"] == "seal-seat"
    scene = parse_seat_scene(document) if seat else parse_scene(document)
    if task == "make":
        # NumPy 2 names its module otherwise than NumPy 1, which reads the file too
        made = pickle.dumps(make(scene), protocol=0)
        mesh_path.write_bytes(made.replace(b"cnumpy._core.", b"cnumpy.core."))
        return
    values, nodes = run(scene, *pickle.loads(mesh_path.read_bytes()))
    out = Path(folder[0])
    out.mkdir(parents=True, exist_ok=True)
    document = {**values, "mesh": {"nodes": nodes}}
    (out / "summary.json").write_text(json.dumps(document), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]), *sys.argv[4:])
