"""Materials that relax: closed forms of vibration and impact, limits, ledgers, fields."""

from __future__ import annotations

import math
from argparse import Namespace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.optimize

from fem_reference.axisymmetric.system import OUTER, PLATE
from fem_reference.common.arrays import Floats
from fem_reference.common.bodies import Relaxation
from fem_reference.common.errors import SceneError
from fem_reference.common.fenicsx import alone
from fem_reference.common.settings import SOLVERS
from fem_reference.explicit.checkpoint import Checkpoint
from fem_reference.explicit.levels import MOST_LEVELS
from fem_reference.explicit.loop import SerialLoop
from fem_reference.explicit.supervision import LEDGER_ERROR
from fem_reference.plate_impact.command import COMMANDS
from fem_reference.plate_impact.estimate import estimate_contact, shortest_wavelengths
from fem_reference.plate_impact.run import Run
from fem_reference.plate_impact.scene import Scene, parse_scene
from fem_reference.plate_impact.solid_model import PlateModel, plate_model
from fem_reference.plate_impact.solid_motion import integrate_solid
from fem_reference.solid.system import make_loop as make_solid_loop

from .conftest import STEEL, document, integrate, make_loop, make_system, vibrating
from .cut_off import CutOffError, cut_off
from .test_film import WATER
from .test_hertz import RIGID

TERMS = [{"ratio": 0.05, "time": 1e-7}, {"ratio": 0.1, "time": 1e-5}, {"ratio": 0.1, "time": 1e-4}]


def relaxing(*bodies: str, terms: list[dict[str, float]] = TERMS, **changes: Any) -> dict[str, Any]:
    """A scene some bodies of which relax."""
    return document(**changes, **{f"{body}__material__relaxation": terms for body in bodies})


def test_relaxation_of_a_scene() -> None:
    scene = parse_scene(relaxing("plate"))
    assert scene.plate.material.relaxation[1] == Relaxation(0.1, 1e-5)
    assert scene.plate.material.lasting == pytest.approx(0.75)
    assert not scene.outer.material.relaxation
    with pytest.raises(SceneError, match=r"plate\.material\.relaxation\[1\]\.time is missing"):
        parse_scene(relaxing("plate", terms=[TERMS[0], {"ratio": 0.6}]))
    tip = {"kind": "compact", "mass": 0.03, "tip_radius": 0.01, "material": dict(STEEL), "gap": 0.0}
    assert parse_scene(document(inner=tip))
    with pytest.raises(SceneError, match=r"inner\.material\.relaxation .* take a sphere"):
        parse_scene(relaxing("inner", inner=tip))


@pytest.mark.parametrize(
    ("mode", "levels"),
    [
        pytest.param(0, MOST_LEVELS, marks=pytest.mark.evidence),
        (2, 1),
        (2, MOST_LEVELS),
    ],
)
def test_free_mode_decays_as_its_prony_roots_say(mode: int, levels: int) -> None:
    """1/(s^2 + omega^2 (1 - sum g/(1 + s tau))), the transform of the answer to a unit velocity.

    By its residues; the oscillation's root alone has the decay.
    """
    system, _ = make_system(parse_scene(relaxing("plate", inner__gap=1e-3)), 0.5)
    motion, modes, weighted = vibrating(system, mode, levels)
    omega = modes.frequencies[mode]
    numerator = np.poly1d([1.0])
    for term in TERMS:
        numerator *= np.poly1d([term["time"], 1.0])
    denominator = np.poly1d([1.0, 0.0, omega**2]) * numerator
    for k, term in enumerate(TERMS):
        others = np.poly1d([1.0])
        for other in TERMS[:k] + TERMS[k + 1 :]:
            others *= np.poly1d([other["time"], 1.0])
        denominator -= omega**2 * term["ratio"] * others
    poles = denominator.roots
    residues = numerator(poles) / denominator.deriv()(poles)
    period = 2.0 * math.pi / float(np.abs(poles.imag).max())
    now = 0.0
    for turn in (0.25, 1.0, 2.25, 5.25):
        samples = round((turn * period - now) / (16 * motion.loop.dt))
        motion.sample(samples, 16)
        now += samples * 16 * motion.loop.dt
        exact = float((residues * np.exp(poles * now)).sum().real)
        place = weighted.T @ motion.loop.u[system.body(PLATE)]
        assert place[mode] == pytest.approx(exact, abs=1e-3 / omega), turn
        assert np.abs(np.delete(place * modes.frequencies, mode)).max() < 1e-3
    assert math.exp(poles.real[np.argmax(poles.imag)] * now) < 0.7


def efficiency(run: Run) -> float:
    """Of a scene with the test's masses and speed."""
    return (run.inner_velocity / 0.55) ** 2


def run_of(scene_document: dict[str, Any], **options: Any) -> Run:
    """A run of a scene."""
    scene = parse_scene(scene_document)
    system, duration = make_system(scene)
    return integrate(system, scene, duration, **options)


def test_terms_that_never_or_at_once_relax_leave_an_elastic_material() -> None:
    """Long after every time constant the modulus is the lasting one."""
    bodies = ("outer", "plate", "inner")
    # both spheres have left the plate then
    end = 1.2e-4
    elastic = run_of(document(), end_time=end)
    slow = run_of(relaxing(*bodies, terms=[{"ratio": 0.3, "time": 1e3}]), end_time=end)
    assert efficiency(slow) == pytest.approx(efficiency(elastic), rel=1e-6)
    soft = {**STEEL, "youngs_modulus": 0.7 * 210e9}
    softer = run_of(document(**{f"{body}__material": soft for body in bodies}), end_time=end)
    fast = run_of(relaxing(*bodies, terms=[{"ratio": 0.3, "time": 1e-10}]), end_time=end)
    assert efficiency(fast) == pytest.approx(efficiency(softer), rel=1e-4)
    assert fast.contacts[0].force_peak == pytest.approx(softer.contacts[0].force_peak, rel=3e-3)
    assert abs(efficiency(softer) - efficiency(elastic)) > 1e-3


@pytest.mark.parametrize("edge", ["clamped", pytest.param("free", marks=pytest.mark.evidence)])
def test_balances_close(edge: str) -> None:
    scene = relaxing("outer", "plate", plate__edge=edge, reference__elements_per_contact_radius=2)
    many = run_of(scene)
    one = run_of(scene, end_time=float(many.times[-1]), most_levels=1)
    for run in (many, one):
        assert run.losses is not None and run.losses.bodies is not None
        outer, plate, inner = (loss / run.initial_energy for loss in run.losses.bodies)
        assert outer > 0.005 and plate > 0.02 and inner == 0.0
        assert run.energy_residual < LEDGER_ERROR * (outer + plate)
        assert run.momentum_residual < 1e-9
        assert abs(run.contact_loss) < 1e-5
    assert one.energy_residual < 2e-5
    assert efficiency(many) == pytest.approx(efficiency(one), abs=1e-4)


def test_threads_relax_as_one() -> None:
    system, _ = make_system(parse_scene(relaxing("outer", "plate")))
    loops = [SerialLoop(system, alone(), threads) for threads in (1, 2)]
    for loop in loops:
        loop.set_step(2e-9, 1, MOST_LEVELS)
        loop.advance(64 * loop.meeting)
    one, two = (loop.springs for loop in loops)
    assert one is not None and two is not None
    largest = np.abs(one.extension).max(axis=(0, 2))
    assert largest.min() > 0.0
    assert (np.abs(one.extension - two.extension).max(axis=(0, 2)) < 1e-10 * largest).all()


def test_damping_and_relaxation_together() -> None:
    run = run_of(
        relaxing("plate", plate__damping_ratio=0.02, reference__elements_per_contact_radius=2),
        most_levels=1,
    )
    assert run.losses is not None and run.losses.bodies is not None
    assert run.losses.plate_damping > 0.005 * run.initial_energy
    assert run.energy_residual < 2e-5


@pytest.mark.parametrize(
    "other_loss",
    [
        {"friction": 0.3},
        {"fluid": WATER},
        pytest.param({"fluid": {**WATER, "viscosity": 0.05}}, marks=pytest.mark.evidence),
        {
            "fluid": {
                **WATER,
                "squeeze_film": False,
                "drag_coefficient": 4e3,
                "added_mass_frequency_ratio": 0.8,
                "plate_damping_ratio": 0.02,
            }
        },
    ],
    ids=["friction", "film", "viscous film", "drag, mass and damping"],
)
def test_balance_closes_with_another_loss(other_loss: dict[str, Any]) -> None:
    # Friction takes energy late, and from slow bodies more of it; films are slow to solve.
    speed, end = (0.55, 1e-4) if "friction" in other_loss else (2.0, 6e-5)
    coarse: dict[str, Any] = {
        "outer__speed": speed,
        "reference__elements_per_contact_radius": 2,
        "run__end_time": end,
    }
    scene = relaxing("outer", "plate", **other_loss, **coarse)
    run = run_of(scene, end_time=end, most_levels=1)
    assert run.losses is not None and run.losses.bodies is not None
    assert sum(run.losses.bodies) > 0.05 * run.initial_energy
    other = run.losses.total - sum(run.losses.bodies)
    assert other > 2e-5 * run.initial_energy
    assert run.energy_residual < 1.5e-5
    assert run.momentum_residual < 1e-9


def test_solid_bodies_relax_in_one_process() -> None:
    options = {"np": 2, "courant": 0.9, "stress_at": (), "fields": 0, "checkpoint": None}
    options |= {"checkpoint_interval": 60.0, "target_error": None, "threads": 0}
    options["solver"] = SOLVERS[0]
    scene = relaxing("plate", reference={"geometry": "solid", "elements_per_contact_radius": 2})
    with pytest.raises(SceneError, match=r"plate\.material\.relaxation .* --np is 2"):
        COMMANDS["solve"](scene, Namespace(**options))


@pytest.mark.parametrize(
    ("elements", "within"), [(5, 0.01), pytest.param(10, 0.005, marks=pytest.mark.evidence)]
)
def test_maxwell_sphere_on_a_rigid_wall_hunter(elements: float, within: float) -> None:
    """1 - e = 4/9 T/tau to first order, T the duration of the elastic contact.

    Hunter 1960, J. Mech. Phys. Solids 8, 219. With half the elements 0.7 % are missing, not 0.3 %.
    """
    changes: dict[str, Any] = {
        "plate__material": RIGID,
        "plate__edge": "free",
        "plate__radius": 0.006,
        "plate__thickness": 0.003,
        "outer__speed": 0.2,
        "inner__gap": 1e-3,
        "run__end_time": 1.1e-4,
        "reference__elements_per_contact_radius": elements,
    }
    elastic = run_of(document(**changes), end_time=1.1e-4)
    duration = elastic.contacts[0].end
    assert duration is not None
    # Next to a Maxwell fluid, which a solid's relaxation may not be.
    terms = [{"ratio": 1.0 - 1e-6, "time": 100.0 * duration}]
    fluid = run_of(relaxing("outer", terms=terms, **changes), end_time=1.1e-4)
    lost = 1.0 - fluid.outer_velocity / elastic.outer_velocity
    assert lost == pytest.approx(4.0 / 9.0 * 0.01, rel=within)


def solid_run(scene: Scene, plate: PlateModel, **options: Any) -> Run:
    """A run in three dimensions, of a scene with its own end."""
    loop = make_solid_loop(plate.model, alone())
    return integrate_solid(loop, plate, scene, estimate_contact(scene).duration, **options)


def test_solid_elements_lose_what_axisymmetric_ones_do(tmp_path: Path) -> None:
    """And a run that is cut off goes on from its checkpoint as if nothing had been."""
    scene = relaxing("outer", "plate", plate__radius=0.012, run={"end_time": 1e-5})
    scene["inner"]["radius"] = scene["outer"]["radius"] = 0.005
    scene["outer"]["speed"] = 6.0
    flat = run_of(scene, end_time=1e-5)
    scene["reference"] = {"geometry": "solid", "elements_per_contact_radius": 2}
    solid = parse_scene(scene)
    estimate = estimate_contact(solid)
    waves = shortest_wavelengths(solid, estimate.duration)
    plate = plate_model(solid, estimate, waves, 1.0)
    whole = solid_run(solid, plate)
    assert whole.energy_residual < 2e-5
    assert flat.losses is not None and flat.losses.bodies is not None
    assert whole.losses is not None and whole.losses.bodies is not None
    # Two elements per contact radius are two elements.
    assert whole.losses.bodies[:2] == pytest.approx(flat.losses.bodies[:2], rel=0.06)
    assert whole.losses.bodies[2] == 0.0 and sum(whole.losses.bodies) > 0.02 * whole.initial_energy
    checkpoint = Checkpoint(tmp_path / "run.npz", "x", 0.0)
    with pytest.raises(CutOffError):
        solid_run(solid, plate, checkpoint=checkpoint, on_progress=cut_off)
    resumed = solid_run(solid, plate, checkpoint=checkpoint)
    assert resumed.losses is not None
    assert np.array_equal(resumed.rows, whole.rows)
    assert resumed.losses.bodies == pytest.approx(whole.losses.bodies, rel=1e-12)


def constant_loss(loss: float, frequency: float) -> tuple[list[dict[str, float]], float]:
    """Terms that hold a loss factor over four decades, and the storage modulus at its frequency."""
    times = 10.0 ** np.arange(-3.0, 3.5, 0.5) / (2.0 * math.pi * frequency)
    x = 2.0 * math.pi * np.geomspace(1e-2, 1e2, 60)[:, None] * frequency * times
    ratios, _ = scipy.optimize.nnls((x + loss) / (1.0 + x**2), np.full(60, loss))
    middle = 1.0 - float((ratios / (1.0 + (2.0 * math.pi * frequency * times) ** 2)).sum())
    return [{"ratio": g, "time": t} for g, t in zip(ratios, times, strict=True) if g > 0], middle


def test_polymer_plate_loses_two_points() -> None:
    """1.88 points of efficiency at a loss factor of 0.02: the explicit elements of a prototype."""
    steel = {"kind": "sphere", "radius": 1.5e-3, "material": dict(STEEL)}
    polymer = {"name": "polymer", "youngs_modulus": 2.6e9, "poisson_ratio": 0.38, "density": 1320.0}
    scene = document(
        plate__radius=5.5e-3,
        plate__thickness=5e-4,
        plate__material=polymer,
        outer={**steel, "speed": 0.55},
        inner={**steel, "gap": 0.0},
    )
    elastic = run_of(scene)
    terms, storage = constant_loss(0.02, 1e4)
    scene["plate"]["material"] |= {"youngs_modulus": 2.6e9 / storage, "relaxation": terms}
    lossy = run_of(scene)
    assert 100.0 * (efficiency(elastic) - efficiency(lossy)) == pytest.approx(1.88, abs=0.06)
    assert lossy.losses is not None and lossy.losses.bodies is not None
    assert lossy.losses.bodies[0] == lossy.losses.bodies[2] == 0.0


def test_stress_relaxes_under_a_strain_that_stays() -> None:
    """Stretched along the axis and held, all nodes alike: the stress falls as the modulus does."""
    scene = parse_scene(relaxing("plate"))
    system, _ = make_system(scene)
    loop = make_loop(system, 2e-9)
    springs = loop.springs
    assert springs is not None
    # Nothing can move.
    loop.inverse[:] = 0.0
    stretched = np.zeros_like(system.points)
    stretched[:, 1] = 1e-4 * system.points[:, 1]
    loop.u[:] = stretched.ravel()
    springs.extension[:] = stretched[:, None, :]
    springs.extension[springs.ratio[springs.body] == 0.0] = 0.0
    loop.strain()
    assert np.allclose(loop.effective, loop.u)
    loop.v[:] = 0.0
    loop.drift(5000)
    retained: Floats = loop.effective / np.where(loop.u == 0.0, 1.0, loop.u)
    rows = system.body(PLATE)
    left = 1.0 - sum(t["ratio"] * (1.0 - math.exp(-1e-5 / t["time"])) for t in TERMS)
    assert np.allclose(
        retained[rows][1::2][stretched[system.first[1] : system.first[2], 1] != 0], left
    )
    assert np.allclose(loop.effective[system.body(OUTER)], loop.u[system.body(OUTER)])
