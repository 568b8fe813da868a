"""Writes the scenes on which releases of FEniCSx are compared: ``small_scenes FOLDER``."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from fem_reference.tests.conftest import document
from fem_reference.tests.seal_seat_scenes import seat_document


def main(folder: Path) -> None:
    """Write ``axisymmetric.json``, ``solid.json`` and ``seal-seat.json``."""
    geometries = {
        "axisymmetric": {"geometry": "axisymmetric", "elements_per_contact_radius": 6},
        "solid": {"geometry": "solid", "elements_per_contact_radius": 2},
    }
    for name, reference in geometries.items():
        scene = document(
            reference=reference,
            plate__radius=0.012,
            outer__radius=0.005,
            inner__radius=0.005,
            outer__speed=2.0,
            run={"end_time": 40e-6},
        )
        (folder / f"{name}.json").write_text(json.dumps(scene), encoding="utf-8")
    seat = seat_document(run={"end_time": 60e-6}, reference__elements_per_ring_radius=6.0)
    (folder / "seal-seat.json").write_text(json.dumps(seat), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
