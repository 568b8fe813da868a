"""Eigenfrequencies of the plate.

Thin circular plates in closed form: omega = k^2/a^2 sqrt(D/(rho h)) with k^2 from Leissa,
Vibration of Plates (NASA SP-160, 1969), nu = 0.3. Thick ones: the frequencies of Table 2.
"""

from __future__ import annotations

import math

import pytest

from fem_reference.axisymmetric.meshing import modal_plate_mesh
from fem_reference.axisymmetric.modal import first_frequency, plate_modes
from fem_reference.common.bodies import Plate
from fem_reference.plate_impact.scene import Scene, parse_scene

from .conftest import STEEL, document, make_system

LEISSA = {
    "clamped": (10.2158, 39.7711, 89.1041, 158.1842),
    "simply-supported": (4.9351, 29.7200, 74.1561),
    "free": (9.0031, 38.4432, 87.7502),
}
TITANIUM = {"name": "titanium", "youngs_modulus": 115e9, "poisson_ratio": 0.37, "density": 4430.0}


def plate(**changes: object) -> Plate:
    return parse_scene(document(**{f"plate__{key}": value for key, value in changes.items()})).plate


@pytest.mark.parametrize("edge", sorted(LEISSA))
def test_thin_plate_leissa(edge: str) -> None:
    thin = plate(edge=edge, thickness=0.033 / 100)
    modes = plate_modes(thin, modal_plate_mesh(thin), len(LEISSA[edge]))
    unit = math.sqrt(thin.bending_stiffness / thin.surface_density) / thin.radius**2
    # Shear and rotary inertia (Mindlin 1951, first order in (h/a)^2) lower the frequencies.
    ratio = (thin.thickness / thin.radius) ** 2 / 24.0 * (1.0 + 2.0 / (0.7 * math.pi**2 / 12.0))
    for mode, exact in zip(modes, LEISSA[edge], strict=True):
        found = 2.0 * math.pi * mode.frequency / unit
        assert found == pytest.approx(exact * (1.0 - ratio * exact), rel=3e-4)
        assert not mode.longitudinal


@pytest.mark.parametrize(
    ("thickness", "bending", "longitudinal"),
    [
        (0.003, 340.8e3, 868.9e3),
        (0.006, 367.5e3, 592.5e3),
        (0.012, 379.5e3, 443.7e3),
    ],
)
def test_thick_titanium_plate_table_2(
    thickness: float, bending: float, longitudinal: float
) -> None:
    thick = plate(radius=0.003, thickness=thickness, material=TITANIUM)
    modes = plate_modes(thick, modal_plate_mesh(thick), 8)
    assert modes[0].frequency == pytest.approx(bending, rel=5e-4)
    first = next(mode.frequency for mode in modes if mode.longitudinal)
    assert first == pytest.approx(longitudinal, rel=5e-4)


def test_time_loop_mesh_has_the_frequency_of_the_continuum(scene: Scene) -> None:
    """Incompatible modes and lumped mass against quadratic elements and consistent mass."""
    exact = plate_modes(scene.plate, modal_plate_mesh(scene.plate), 1)[0].frequency
    errors = [first_frequency(make_system(scene, f)[0]) / exact - 1.0 for f in (1.0, 2.0)]
    # Without the parasitic shear of plain bilinear elements (4e-3) what is left is of the size of
    # the error of the quadratic elements at the clamped edge's corner.
    assert max(abs(error) for error in errors) < 1e-4


def test_free_plate_has_no_rigid_mode_in_the_list() -> None:
    free = plate(edge="free")
    supported = parse_scene(document(plate__edge="free", plate__material=STEEL))
    lowest = plate_modes(free, modal_plate_mesh(free), 1)[0].frequency
    assert first_frequency(make_system(supported)[0]) == pytest.approx(lowest, rel=1e-2)
    kirchhoff = 9.0031 * math.sqrt(free.bending_stiffness / free.surface_density)
    assert 2 * math.pi * lowest == pytest.approx(kirchhoff / free.radius**2, rel=0.02)
