"""Table 2 of the paper: fixed titanium plate of radius 3 mm, first and first longitudinal mode.

The four thick plates' frequencies are in `test_modal`; here the thin ones, the numbers of the
longitudinal modes, and the convergence of the mesh that the command ``modes`` uses.
"""

from __future__ import annotations

import pytest

from fem_reference.axisymmetric.meshing import mesh_plate, modal_plate_mesh
from fem_reference.axisymmetric.modal import plate_modes
from fem_reference.axisymmetric.sizes import MeshSettings
from fem_reference.common.bodies import Plate
from fem_reference.plate_impact.scene import parse_scene

from .conftest import document

TITANIUM = {"name": "titanium", "youngs_modulus": 115e9, "poisson_ratio": 0.37, "density": 4430.0}


def plate(thickness: float) -> Plate:
    changes = {"plate__radius": 0.003, "plate__thickness": thickness, "plate__material": TITANIUM}
    return parse_scene(document(**changes)).plate


@pytest.mark.parametrize(
    ("thickness", "first", "longitudinal"),
    # independent FE prototype; the paper has 29 / 1116 and 136 / 1117 kHz
    [(0.0001, 28.5e3, 1116.0e3), (0.0005, 133.5e3, 1117.0e3)],
)
def test_thin_plates(thickness: float, first: float, longitudinal: float) -> None:
    thin = plate(thickness)
    modes = plate_modes(thin, modal_plate_mesh(thin), 8)
    # half of the last digit given: 50 Hz of 28.5 kHz
    assert modes[0].frequency == pytest.approx(first, abs=50.0)
    found = next(mode.frequency for mode in modes if mode.longitudinal)
    assert found == pytest.approx(longitudinal, abs=550.0)


@pytest.mark.parametrize(
    ("thickness", "number"), [(0.0001, 7), (0.0005, 4), (0.003, 3), (0.006, 2), (0.012, 2)]
)
def test_number_of_the_first_longitudinal_mode(thickness: float, number: int) -> None:
    body = plate(thickness)
    modes = plate_modes(body, modal_plate_mesh(body), 8)
    assert [mode.longitudinal for mode in modes].index(True) + 1 == number


def test_mesh_of_the_modes_is_fine_enough() -> None:
    """Within 0.05 % of cubic elements twice as fine, from above."""
    thin = plate(0.0005)
    size = thin.thickness / 24.0
    settings = MeshSettings(size, 1, size, size, 1.2, 1.2)
    fine = plate_modes(thin, mesh_plate(thin, settings), 4, degree=3)
    for ours, exact in zip(plate_modes(thin, modal_plate_mesh(thin), 4), fine, strict=True):
        assert 0.0 < ours.frequency / exact.frequency - 1.0 < 5e-4
