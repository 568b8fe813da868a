"""Stacks: the rod against Love's frequencies, and its way to the plate."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg

from fem_reference.axisymmetric.stack import StackBody
from fem_reference.common.bodies import Material, Stack, Supply
from fem_reference.common.errors import SceneError

STACK = Stack(
    length=18e-3,
    area=25e-6,
    stroke=17.4e-6,
    blocked_force=850.0,
    voltage=150.0,
    capacitance=1.4e-6,
    density=8000.0,
    poisson_ratio=0.3,
    tip_radius=4e-3,
    gap=0.0,
    drive=None,
    material=Material("steel", 210e9, 0.3, 7780.0),
)
"""Of the class of TOKIN's AE0505D16DF (data sheet)."""


def love(stack: Stack, count: int) -> list[float]:
    """Angular frequencies of the rod with lateral inertia, rad/s."""
    speed = stack.step_speed * stack.length / stack.stroke
    kappa = [(2 * k + 1) * math.pi / (2.0 * stack.length) for k in range(count)]
    lateral = stack.poisson_ratio * stack.radius / math.sqrt(2.0)
    return [k * speed / math.sqrt(1.0 + (lateral * k) ** 2) for k in kappa]


def test_frequencies_are_loves() -> None:
    body = StackBody(STACK, 12)
    free = np.setdiff1d(np.arange(2 * body.count), body.fixed)
    stiffness = body.matrices.stiffness[free][:, free].tocsc()
    mass = scipy.sparse.diags(np.repeat(body.matrices.mass, 2)[free]).tocsc()
    squares = scipy.sparse.linalg.eigsh(stiffness, 3, mass, sigma=0.0, return_eigenvectors=False)
    found = np.sqrt(np.sort(squares))
    errors = np.abs(found / love(STACK, 3) - 1.0)
    assert (errors < [1e-4, 2e-3, 1.1e-2]).all(), errors


def test_rod_is_as_stiff_as_stroke_and_blocked_force_say() -> None:
    body = StackBody(STACK, 8)
    free = np.setdiff1d(np.arange(2 * body.count), body.fixed)
    load = np.zeros(2 * body.count)
    load[-1] = -STACK.blocked_force
    moved = scipy.sparse.linalg.spsolve(body.matrices.stiffness[free][:, free].tocsc(), load[free])
    # The cap holds its rim, which costs a little.
    assert 0.99 * STACK.stroke < -moved[-1] < STACK.stroke


@pytest.mark.parametrize("drive", [None, Supply(1.0, 20e-6), Supply(5.0, None)])
def test_balance_up_to_the_first_contact(drive: Supply | None) -> None:
    body = StackBody(dataclasses.replace(STACK, gap=6e-6, drive=drive), 6)
    first_contact, matrices = body.first_contact, body.matrices
    u, v = first_contact.displacement.ravel(), first_contact.velocity.ravel()
    assert -u[-1] == pytest.approx(6e-6, rel=1e-9)
    energy = 0.5 * u @ (matrices.stiffness @ u) + 0.5 * np.repeat(matrices.mass, 2) @ v**2
    assert energy == pytest.approx(first_contact.work, rel=2e-3)
    if drive is None:
        # Behind the wave the tip has its speed.
        assert 6e-6 / first_contact.time == pytest.approx(STACK.step_speed, rel=0.06)
        return
    taken = STACK.voltage * first_contact.charge - 0.5 * drive.elastance * first_contact.charge**2
    voltage = (first_contact.charge + STACK.force_per_voltage * u[-1]) / STACK.clamped_capacitance
    stored = 0.5 * STACK.clamped_capacitance * voltage**2 + first_contact.work
    assert taken == pytest.approx(stored + first_contact.heat, rel=1e-3)


def test_a_plate_out_of_reach_is_reported() -> None:
    body = StackBody(dataclasses.replace(STACK, gap=40e-6), 3)
    with pytest.raises(SceneError, match=r"outer\.gap is 4e-05 m"):
        _ = body.first_contact
