"""Modal damping of the plate: closed form of a free mode, ledgers, modes that are omitted."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fem_reference.axisymmetric.system import PLATE
from fem_reference.common.errors import SceneError
from fem_reference.explicit.energies import energies_of
from fem_reference.explicit.levels import MOST_LEVELS
from fem_reference.impact.ending import least_clearance
from fem_reference.plate_impact import axisymmetric_motion
from fem_reference.plate_impact.axisymmetric_motion import AxisymmetricMotion
from fem_reference.plate_impact.result import of_run
from fem_reference.plate_impact.scene import parse_scene

from .conftest import document, integrate, make_system, vibrating

RATIO = 0.04


def test_damping_ratio_of_a_scene() -> None:
    assert parse_scene(document(plate__damping_ratio=RATIO)).plate.damping_ratio == RATIO
    with pytest.raises(SceneError, match=r"plate\.damping_ratio is 1; .* below 1"):
        parse_scene(document(plate__damping_ratio=1.0))
    with pytest.raises(SceneError, match=r"plate\.damping_ratio.*solid"):
        parse_scene(document(plate__damping_ratio=RATIO, reference__geometry="solid"))


@pytest.mark.parametrize("levels", [1, MOST_LEVELS])
@pytest.mark.parametrize("mode", [0, 2])
def test_free_mode_decays_as_its_closed_form(mode: int, levels: int) -> None:
    """Of the mode exp(-zeta omega t) sin(omega_d t) / omega_d; the others stay at rest."""
    system, _ = make_system(parse_scene(document(inner__gap=1e-3)), 0.5)
    motion, modes, weighted = vibrating(system, mode, levels, RATIO)
    loop, damping = motion.loop, motion.damping
    assert damping is not None
    omega = float(modes.frequencies[mode])
    damped = omega * math.sqrt(1.0 - RATIO**2)
    before = energies_of(loop).elastic[PLATE]
    stride, now = 16, 0.0
    period = 2.0 * math.pi / damped
    rows = system.body(PLATE)
    for turn in (0.25, 1.0, 2.25):
        samples = round((turn * period - now) / (stride * loop.dt))
        motion.sample(samples, stride)
        now += samples * stride * loop.dt
        exact = math.exp(-RATIO * omega * now) * math.sin(damped * now) / damped
        place = weighted.T @ loop.u[rows]
        assert place[mode] == pytest.approx(exact, abs=2e-3 / omega)
        assert np.abs(np.delete(place, mode) * np.delete(modes.frequencies, mode)).max() < 1e-3
    assert not loop.is_in_contact
    after = energies_of(loop).elastic[PLATE]
    # The kinetic part decays between losses only on the average over a period.
    assert after / before == pytest.approx(math.exp(-2.0 * RATIO * omega * now), rel=0.05)
    assert after + damping.dissipated == pytest.approx(before, rel=1e-10 if levels == 1 else 1e-4)


@pytest.mark.parametrize("edge", ["clamped", "free"])
def test_balances_close(edge: str) -> None:
    scene = parse_scene(document(plate__edge=edge, plate__damping_ratio=RATIO))
    system, duration = make_system(scene, 0.5)
    many = integrate(system, scene, duration)
    one = integrate(system, scene, duration, end_time=float(many.times[-1]), most_levels=1)
    assert many.energy_residual < 1e-5
    # Round-off: without damping it is as large.
    assert one.energy_residual < 1e-10
    for run in (many, one):
        assert run.momentum_residual < 1e-9
        assert abs(run.contact_loss) < 1e-5
        assert run.losses is not None
        assert 0.01 < run.losses.plate_damping / run.initial_energy < 0.2
    assert many.losses is not None and one.losses is not None
    assert many.losses.plate_damping == pytest.approx(one.losses.plate_damping, rel=1e-3)


def test_modes_of_a_free_plate_take_no_momentum() -> None:
    scene = parse_scene(document(plate__edge="free", plate__damping_ratio=RATIO))
    system, duration = make_system(scene)
    motion = AxisymmetricMotion(system)
    motion.damp(RATIO, 24.0 * 2.0 * math.pi / duration)
    motion.loop.set_step(2e-9, 1)
    motion.sample(1000, 16)
    damping = motion.damping
    assert damping is not None and damping.dissipated > 0.0
    assert abs(damping.impulse) < 1e-9 * scene.outer.mass * scene.speed


def test_modes_left_undamped_change_next_to_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice the frequency up to which modes are damped, and losses twice as often."""
    scene = parse_scene(document(plate__damping_ratio=RATIO))
    system, duration = make_system(scene)
    found = of_run(scene, integrate(system, scene, duration))
    limit = 2.0 * axisymmetric_motion.DAMPED_FREQUENCY
    monkeypatch.setattr(axisymmetric_motion, "DAMPED_FREQUENCY", limit)
    more = of_run(scene, integrate(system, scene, duration))
    undamped = of_run(scene, integrate(system, parse_scene(document()), duration))
    for name in ("efficiency", "outer_velocity_final", "outer_force_peak", "inner_force_peak"):
        effect = abs(found[name] / undamped[name] - 1.0)
        assert effect > 1e-3, name
        assert abs(more[name] / found[name] - 1.0) < 0.02 * effect, name


def test_clearance_over_decaying_oscillations() -> None:
    """A bound below what it bounds, and close to it: 2 + 2 t - e^(-t/5) (3 cos 4 t + sin 9 t)."""
    amplitudes, exponents = np.array([3.0, -1.0j]), np.array([-0.2 + 4.0j, -0.2 + 9.0j])
    t = np.linspace(0.0, 20.0, 200001)
    curve = 2.0 + 2.0 * t - np.exp(-0.2 * t) * (3.0 * np.cos(4.0 * t) + np.sin(9.0 * t))
    bound = least_clearance(2.0, 2.0, amplitudes, exponents)
    assert curve.min() - 0.05 < bound <= curve.min()
