"""Fluid moved by a plate: potential flow against closed forms in Hankel's transform.

Of a plate flush in a rigid wall 1/2 w^T M w = pi rho int_0^inf W(k)^2 dk, with
W(k) = int w J0(k r) r dr.
"""

from __future__ import annotations

import json
import math
from argparse import Namespace
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import iv, jv

from fem_reference.axisymmetric.added_mass import AddedMass, added_mass, wet_frequencies
from fem_reference.axisymmetric.meshing import modal_plate_mesh
from fem_reference.axisymmetric.modal import plate_modes
from fem_reference.common.errors import SolverError
from fem_reference.plate_impact.command import COMMANDS
from fem_reference.plate_impact.scene import parse_scene

from .conftest import document
from .program import run_program
from .test_film import WATER

RADIUS = 0.033
LAMB = 0.6689
"""Kinetic energy of the fluid over the plate's with the deflection (1 - r^2/R^2)^2, over
rho_f R/(rho_p t)."""


def factor(fluid: AddedMass, shape: Callable[[float], float]) -> float:
    """Kinetic energy of the fluid over that of a plate of unit mass per area, over the radius."""
    values = np.array([shape(r / RADIUS) for r in fluid.radii])
    plate = float(quad(lambda x: 2.0 * math.pi * x * shape(x) ** 2, 0.0, 1.0)[0]) * RADIUS**3
    return float(values @ fluid.matrix @ values) / plate


def lambs_shape(x: float) -> float:
    return (1.0 - x**2) ** 2


def test_lambs_plate_and_convergence_to_it() -> None:
    exact = 640.0 * quad(lambda k: (jv(3, k) / k**3) ** 2, 1e-9, 200.0, limit=500)[0]
    assert exact == pytest.approx(LAMB, abs=1e-4)
    errors = [
        abs(factor(added_mass(RADIUS, n, 1), lambs_shape) / exact - 1.0) for n in (12, 24, 48)
    ]
    assert errors[0] < 0.01
    assert errors[1] < errors[0] / 3.0 and errors[2] < errors[1] / 3.0
    assert factor(added_mass(RADIUS), lambs_shape) == pytest.approx(exact, rel=1e-4)


def test_clamped_plate_in_its_first_mode() -> None:
    """Kirchhoff's mode J0(l x) - c I0(l x): 0.65381 (Kwak 1991)."""
    root = brentq(lambda x: jv(0, x) * iv(1, x) + iv(0, x) * jv(1, x), 3.0, 3.4)
    c = jv(0, root) / iv(0, root)

    def transform(k: float) -> float:
        oscillating = root * jv(1, root) * jv(0, k) - k * jv(0, root) * jv(1, k)
        growing = root * iv(1, root) * jv(0, k) + k * iv(0, root) * jv(1, k)
        return float(oscillating / (root**2 - k**2) - c * growing / (root**2 + k**2))

    def shape(x: float) -> float:
        return float(jv(0, root * x) - c * iv(0, root * x))

    fluid = quad(lambda k: transform(k) ** 2, 0.0, 300.0, limit=2000)[0]
    exact = fluid / quad(lambda x: shape(x) ** 2 * x, 0.0, 1.0)[0]
    assert exact == pytest.approx(0.65381, abs=1e-4)
    assert factor(added_mass(RADIUS), shape) == pytest.approx(exact, rel=2e-4)


def test_matrix_is_symmetric_and_positive() -> None:
    matrix = added_mass(RADIUS).matrix
    np.testing.assert_allclose(matrix, matrix.T, atol=1e-12 * matrix.max())
    assert np.linalg.eigvalsh(matrix).min() > 0.0


@pytest.mark.parametrize(
    ("edge", "slender"),
    [("clamped", 20.0), pytest.param("free", 40.0, marks=pytest.mark.evidence)],
)
def test_wet_frequencies_of_a_thin_plate(edge: str, slender: float) -> None:
    """Lamb's formula for a clamped steel plate in water; all modes fall, the slow ones most."""
    plate = parse_scene(document(plate__thickness=RADIUS / slender, plate__edge=edge)).plate
    mesh = modal_plate_mesh(plate)
    dry = np.array([mode.frequency for mode in plate_modes(plate, mesh, 4)])
    wet = wet_frequencies(plate, mesh, 4, 1000.0)
    ratios = wet / dry
    assert np.all(np.diff(ratios) > 0.0) and ratios[-1] < 0.95
    if edge == "clamped":
        lamb = 1.0 / math.sqrt(1.0 + LAMB * 1000.0 * slender / 7780.0)
        # Of Lamb's shape; the true one moves 2.3 % less.
        assert lamb < ratios[0] < 1.012 * lamb
        more = wet_frequencies(plate, mesh, 8, 1000.0)
        np.testing.assert_allclose(wet, more[:4], rtol=1e-4)
    assert wet_frequencies(plate, mesh, 4, 1e-9) == pytest.approx(dry, rel=1e-9)


def test_command_gives_the_modes_and_the_ratio_of_a_scene(tmp_path: Path) -> None:
    scene = tmp_path / "scene.json"
    scene.write_text(json.dumps(document(fluid=WATER)), encoding="utf-8")
    arguments = ("modes", "--count", "6", "--wet", "--scene", str(scene))
    found = json.loads(run_program(*arguments).stdout)
    frequencies = [mode["frequency"] for mode in found["modes"]]
    assert frequencies == sorted(frequencies)
    assert [mode["longitudinal"] for mode in found["modes"]] == [False] * 5 + [True]
    ratio = found["wet"]["frequencies"][0] / found["modes"][0]["frequency"]
    assert found["wet"]["added_mass_frequency_ratio"] == pytest.approx(ratio)
    assert ratio == pytest.approx(1.0 / math.sqrt(1.0 + 0.6538 * 1000.0 / 7780.0 * 16.5), rel=0.01)
    with pytest.raises(SolverError, match=r"\[fluid\]"):
        COMMANDS["modes"](document(), Namespace(count=6, wet=True))
