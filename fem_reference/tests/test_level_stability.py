"""Stability of sub-cycling from the eigenvalues of one long step, by dense linear algebra.

A step of length D, at whose ends all levels meet, is reversible: u_{n+1} + u_{n-1} = 2 A u_n. What
has A w = alpha w is multiplied by alpha +- sqrt(alpha^2 - 1) per long step: by 1 in magnitude if
alpha is real and in [-1, 1], by more otherwise.
"""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse

from fem_reference.axisymmetric.system import AxisymmetricSystem, critical_time_step
from fem_reference.common.arrays import Floats, Ints
from fem_reference.common.fenicsx import alone
from fem_reference.explicit import levels as levels_module
from fem_reference.explicit.levels import LEVEL_MARGIN, MOST_LEVELS, least_at_nodes
from fem_reference.explicit.spectrum import critical_time_step as solid_critical_time_step
from fem_reference.plate_impact.scene import parse_scene
from fem_reference.seal_seat.meshing import seat_mesh
from fem_reference.seal_seat.model import seat_model
from fem_reference.seal_seat.scene import parse_seat_scene
from fem_reference.solid.system import make_loop as make_solid_loop
from fem_reference.tests.conftest import document, make_loop, make_system
from fem_reference.tests.seal_seat_scenes import seat_document

OPEN, CLOSED = (0, 0), (3, 2)
"""Closed pairs of nodes, outer and inner contact."""
RIGID = 1e-7
"""1 - alpha of a rigid motion, at most; its double root at 1 is no growth."""


@pytest.fixture(scope="module")
def system() -> AxisymmetricSystem:
    """Plate between spheres as in Table 1, smaller and coarse: some 800 components."""
    small = document(
        reference={"geometry": "axisymmetric", "elements_per_contact_radius": 3},
        plate__radius=0.012,
        outer__radius=0.005,
        inner__radius=0.005,
        outer__speed=2.0,
    )
    return make_system(parse_scene(small), 0.4)[0]


def level_parts(
    system: AxisymmetricSystem, step: float, closed: tuple[int, int]
) -> tuple[list[scipy.sparse.csr_matrix], Floats, Ints, Ints]:
    """Stiffness of the levels, masses, level of each component, and which of the system's it is.

    A closed pair moves along the axis as one: the multiplier of every step takes out what else
    the predictor does. Its sphere's component is then the plate's.
    """
    level = make_loop(system, step).element_levels(step, MOST_LEVELS)
    node = least_at_nodes(level, system.element_nodes, system.mass.size)
    size = 2 * system.mass.size
    stands_for = np.arange(size)
    for pairs, count in zip(system.matched, closed, strict=True):
        stands_for[2 * pairs.candidates[:count] + 1] = 2 * pairs.opposite[:count] + 1
    independent = np.flatnonzero((stands_for == np.arange(size)) & (system.inverse_mass > 0.0))
    number = np.full(size, -1)
    number[independent] = np.arange(independent.size)
    rows = np.flatnonzero(number[stands_for] >= 0)
    chosen = scipy.sparse.csr_matrix(
        (np.ones(rows.size), (rows, number[stands_for[rows]])), shape=(size, independent.size)
    )
    mass = chosen.T @ np.repeat(system.mass, 2)
    parts = [chosen.T @ system.part(level == k) @ chosen for k in range(int(level.max()) + 1)]
    return parts, mass, node[independent // 2], independent


def long_step(
    parts: list[scipy.sparse.csr_matrix], mass: Floats, level: Ints, step: float
) -> Floats:
    """A: where a long step from rest leads, from every unit displacement."""
    u = np.eye(mass.size)
    v = sum(0.5 * 2**k * step * part.toarray() for k, part in enumerate(parts)) / mass[:, None]
    for number in range(2 ** (len(parts) - 1)):
        for k in reversed(range(len(parts))):
            if number % 2**k == 0:
                v -= 2**k * step * (parts[k] @ u) / mass[:, None]
                u[level == k] += 2**k * step * v[level == k]
    return u


def growth(matrix: Floats) -> float:
    """Largest factor per long step of any vibration, minus 1."""
    alpha = np.linalg.eigvals(matrix).astype(complex)
    alpha = alpha[np.abs(alpha - 1.0) > RIGID]
    root = np.sqrt(alpha**2 - 1.0)
    return float(np.maximum(np.abs(alpha + root), np.abs(alpha - root)).max()) - 1.0


@pytest.mark.parametrize("closed", [OPEN, CLOSED])
@pytest.mark.parametrize("courant", [0.5, 0.6, 0.9])
def test_no_vibration_grows(
    system: AxisymmetricSystem, courant: float, closed: tuple[int, int]
) -> None:
    step = courant * critical_time_step(system)
    parts, mass, level, _ = level_parts(system, step, closed)
    assert len(parts) > 2
    assert growth(long_step(parts, mass, level, step)) < 1e-12


def test_levels_up_to_the_critical_step_resonate(
    system: AxisymmetricSystem, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = {}
    for margin in (LEVEL_MARGIN, 0.99):
        monkeypatch.setattr(levels_module, "LEVEL_MARGIN", margin)
        for courant, closed in ((0.6, OPEN), (0.9, CLOSED)):
            step = courant * critical_time_step(system)
            parts, mass, level, _ = level_parts(system, step, closed)
            found[margin, closed] = growth(long_step(parts, mass, level, step))
    # 17 % per long step, and 1e-5, seen only where bodies touch.
    assert found[0.99, OPEN] > 0.1 and found[0.99, CLOSED] > 1e-6
    assert max(found[LEVEL_MARGIN, OPEN], found[LEVEL_MARGIN, CLOSED]) < 1e-12


def test_the_long_step_is_that_of_the_compiled_loop(system: AxisymmetricSystem) -> None:
    step = 0.9 * critical_time_step(system)
    parts, mass, level, independent = level_parts(system, step, OPEN)
    loop = make_loop(system, step, MOST_LEVELS)
    u = np.random.default_rng(1).standard_normal(independent.size)
    start = sum(0.5 * 2**k * step * (part @ u) for k, part in enumerate(parts)) / mass
    loop.u[independent], loop.v[independent] = u, start
    loop.drift(2 ** (len(parts) - 1))
    expected = long_step(parts, mass, level, step) @ u
    assert np.abs(loop.u[independent] - expected).max() < 1e-11 * np.abs(expected).max()


def test_no_vibration_of_a_solid_grows() -> None:
    """Tetrahedra, by the compiled loop itself."""
    design = parse_seat_scene(seat_document(reference__element_order=1))
    loop = make_solid_loop(seat_model(design, seat_mesh(design, 0.3)).model, alone())
    loop.set_step(0.9 * solid_critical_time_step(loop), 1, MOST_LEVELS)
    assert len(loop.levels) > 1
    free = np.flatnonzero(loop.inverse > 0.0)
    matrix = np.empty((free.size, free.size))
    for column, component in enumerate(free):
        unit = np.zeros(loop.u.size)
        unit[component] = 1.0
        loop.u[:], loop.v[:] = unit, 0.0
        for k in range(len(loop.levels)):
            loop.v += 0.5 * 2**k * loop.dt * loop.inverse * loop.level_product(k, unit)
        loop.drift(loop.meeting)
        matrix[:, column] = loop.u[free]
    assert growth(matrix) < 1e-12
