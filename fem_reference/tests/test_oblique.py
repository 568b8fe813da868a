"""Impacts beside the centre of the plate and at an angle, against closed forms and conservation."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp, trapezoid
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp

from fem_reference.common.errors import SceneError
from fem_reference.common.fenicsx import alone
from fem_reference.common.hertz import hertz_stiffness
from fem_reference.explicit.loop import Loop
from fem_reference.explicit.spectrum import body_rotation
from fem_reference.plate_impact.estimate import estimate_contact, shortest_wavelengths
from fem_reference.plate_impact.half_model import half_model
from fem_reference.plate_impact.half_motion import HalfMotion
from fem_reference.plate_impact.result import of_run
from fem_reference.plate_impact.run import Run
from fem_reference.plate_impact.scene import Scene, parse_scene
from fem_reference.plate_impact.solid_model import PlateModel, plate_model
from fem_reference.plate_impact.solid_motion import SolidMotion, integrate_solid
from fem_reference.solid.system import make_loop

from .conftest import STEEL, document

HARD = {"name": "hard", "youngs_modulus": 2e13, "poisson_ratio": 0.3, "density": 77800.0}
"""A hundred times as stiff as steel."""
BLOCK: dict[str, Any] = {
    "plate__radius": 0.008,
    "plate__thickness": 0.006,
    "plate__material": HARD,
    "outer__radius": 0.005,
    "inner__radius": 0.005,
    "inner__gap": 1e-3,
}
"""A plate that hardly moves, and an inner body out of reach."""
SMALL: dict[str, Any] = {
    "plate__radius": 0.012,
    "plate__thickness": 0.002,
    "outer__radius": 0.005,
    "inner__radius": 0.005,
}


@dataclass(frozen=True)
class Struck:
    """A run and what it was made with."""

    scene: Scene
    plate: PlateModel
    loop: Loop
    run: Run

    @property
    def lost(self) -> float:
        """Velocity along the plate that the outer body has lost, m/s."""
        assert self.run.sideways is not None
        return self.scene.tangential_velocity - self.run.sideways.velocities[0]

    @property
    def spin(self) -> float:
        """Of the outer body, rad/s."""
        assert self.run.sideways is not None
        return self.run.sideways.spins[0]

    @property
    def inertia(self) -> float:
        """Of the outer body over 2/5 m r^2."""
        if "outer" in self.plate.rigid:
            return 1.0
        rotation = body_rotation(self.loop, self.plate.elastic["outer"])
        whole = self.loop.dot(rotation, rotation * np.repeat(self.loop.mass, 3)) / 0.5
        return whole / (0.4 * self.scene.outer.mass * self.scene.outer.tip_radius**2)


def oblique(
    rigid: str = "both", order: int = 1, elements: float = 2.0, **changes: Any
) -> dict[str, Any]:
    """A scene in three dimensions; its bodies are rigid but for the plate."""
    reference = {
        "geometry": "solid",
        "elements_per_contact_radius": elements,
        "element_order": order,
        "rigid": rigid,
    }
    return document(reference=reference, **changes)


def strike(whole: dict[str, Any], half: bool = True, **options: Any) -> Struck:
    """A run on one mesh; of a quarter of the bodies, if not of a half."""
    scene = parse_scene(whole)
    estimate = estimate_contact(scene)
    model = half_model if half else plate_model
    plate = model(scene, estimate, shortest_wavelengths(scene, estimate.duration), 1.0)
    loop = make_loop(plate.model, alone())
    motion = HalfMotion if half else SolidMotion
    run = integrate_solid(loop, plate, scene, estimate.duration, motion, **options)
    return Struck(scene, plate, loop, run)


def test_what_an_oblique_impact_cannot_have() -> None:
    assert parse_scene(oblique()).centred
    made = parse_scene(oblique(outer__offset=2e-3, outer__angle=-0.5, friction=0.3))
    assert not made.centred
    assert made.normal_speed == pytest.approx(0.55 * math.cos(0.5))
    assert made.tangential_velocity == pytest.approx(-0.55 * math.sin(0.5))
    compact = {"kind": "compact", "mass": 1e-3, "tip_radius": 1e-2, "material": STEEL, "gap": 0.0}
    changes: tuple[tuple[dict[str, Any], str], ...] = (
        ({"outer__angle": 0.1, "friction": 0.1, "inner": compact}, r"friction is 0.1"),
        ({"outer__spin": 20.0}, r"outer.spin is 20 rad/s"),
        ({"outer__offset": 1e-3, "series": {"impacts": 2, "sphere_spot": "same"}}, "series"),
    )
    for change, said in changes:
        with pytest.raises(SceneError, match=said):
            parse_scene(oblique(**change))
    with pytest.raises(SceneError, match=r"outer.angle is 0.1 rad.*reference.geometry 'solid'"):
        parse_scene(document(outer__angle=0.1))
    near = parse_scene(oblique(outer__offset=0.032))
    with pytest.raises(SceneError, match=r"plate.radius less outer.offset is 0.001 m"):
        strike(near.raw)


@pytest.mark.parametrize("rigid", [pytest.param("both", marks=pytest.mark.evidence), "none"])
def test_a_half_struck_at_the_centre_is_what_a_quarter_is(rigid: str) -> None:
    # The meshes are not the same: force peaks of linear elements differ by up to 1.3 % for that.
    small = SMALL | {"plate__radius": 0.01}
    scene = oblique(rigid, 2 if rigid == "both" else 1, **small, outer__speed=1.5)
    half, quarter = (strike(scene, half) for half in (True, False))
    assert half.run.sideways is not None
    assert np.abs(half.run.sideways.velocities).max() < 1e-3 * half.scene.speed
    found, expected = of_run(half.scene, half.run), of_run(quarter.scene, quarter.run)
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=0.01 if rigid == "both" else 0.03), name


@pytest.mark.parametrize(
    ("rigid", "elements"),
    [("both", 2.0), pytest.param("inner", 2.5, marks=pytest.mark.evidence)],
)
def test_a_sliding_ball_loses_friction_times_the_normal_impulse(
    rigid: str, elements: float
) -> None:
    """Of its tangential velocity mu (1 + e) v_n, and it spins with 5/2 of that over its radius."""
    found = strike(
        oblique(rigid, 1, elements, outer__angle=math.radians(60.0), friction=0.1, **BLOCK)
    )
    run, scene = found.run, found.scene
    gained = run.outer_velocity + scene.normal_speed
    assert run.outer_velocity == pytest.approx(scene.normal_speed, rel=0.01)
    assert found.lost == pytest.approx(scene.friction * gained, rel=4e-3)
    assert found.inertia == pytest.approx(1.0, abs=0.03)
    turned = 2.5 * found.lost / scene.outer.tip_radius
    assert found.inertia * found.spin == pytest.approx(turned, rel=4e-3)
    assert run.losses is not None
    slid = scene.friction * scene.outer.mass * gained
    mean = scene.tangential_velocity - 0.5 * 3.5 * found.lost
    assert run.losses.contacts[0] == pytest.approx(slid * mean, rel=0.01)
    assert run.energy_residual < 2e-4
    assert run.momentum_residual < 1e-11


def rolled(scene: Scene, inertia: float) -> float:
    """Tangential velocity (m/s) that an elastic ball loses on a rigid wall it never slips on.

    Hertz along the normal; along the wall every annulus of the contact holds from when it closes
    until it opens: F = 8 G' int_0^a (d - d(a')) da', d(a') the displacement when the radius first
    was a' (Jaeger, Arch. Appl. Mech. 65, 1995; the stick limit of Maw, Barber & Fawcett, Wear 38,
    1976). A ball whose moment of inertia is ``inertia`` times 2/5 m r^2 has there 2/7 of its mass.
    """
    ball, mass = scene.outer, scene.outer.mass
    material = ball.material
    normal = hertz_stiffness(material.plane_strain_modulus, ball.tip_radius)
    tangential = 8.0 * material.shear_modulus / (2.0 - material.poisson_ratio)
    step, lighter = 1e-8, 1.0 + 2.5 / inertia
    z, v, d, w = 0.0, scene.normal_speed, 0.0, scene.tangential_velocity
    radii, stuck = [0.0], [0.0]
    start = w
    while True:
        a = math.sqrt(max(z, 0.0) * ball.tip_radius)
        if a > radii[-1]:
            radii.append(a)
            stuck.append(d)
        inside = np.searchsorted(radii, a, side="right")
        stretched = d - np.array(stuck[:inside])
        force = tangential * float(trapezoid(stretched, radii[:inside]))
        v -= step * normal * max(z, 0.0) ** 1.5 / mass
        w -= step * lighter * force / mass
        z, d = z + step * v, d + step * w
        if z <= 0.0:
            return (start - w) / lighter


def test_a_ball_that_does_not_slip_springs_back_along_the_wall() -> None:
    found = strike(
        oblique(
            "inner",
            1,
            3.0,
            outer__angle=math.radians(20.0),
            outer__speed=1.0,
            friction=5.0,
            **BLOCK,
        )
    )
    expected = rolled(found.scene, found.inertia)
    # A rigid ball would roll, and lose 2/7 of its tangential velocity.
    assert expected < 0.85 * 2.0 / 7.0 * found.scene.tangential_velocity
    assert found.lost == pytest.approx(expected, rel=0.05)


def angular_momentum(found: Struck) -> tuple[float, float]:
    """About y at start and end, of the part modelled, kg m^2/s."""
    scene, loop, problem = found.scene, found.loop, found.loop.problem
    points = loop.system.points[loop.system.owned]
    v = loop.v.reshape(-1, 3)
    end = float(loop.mass @ (points[:, 2] * v[:, 0] - points[:, 0] * v[:, 2]))
    start = 0.0
    half = 0.5 * scene.plate.thickness
    for row, (body, x, side) in enumerate(((scene.outer, scene.offset, 1.0), (scene.inner, 0, -1))):
        z, rigid = side * (half + body.tip_radius), problem.rigids[row]
        inertia = 0.4 * rigid.mass * body.tip_radius**2
        place = np.array([x, 0.0, z]) + rigid.u
        end += rigid.mass * (place[2] * rigid.v[0] - place[0] * rigid.v[2])
        end += inertia * rigid.spin[1]
        if row == 0:
            start = rigid.mass * (z * scene.tangential_velocity + x * scene.normal_speed)
    return start, end


def test_a_free_plate_keeps_momentum_angular_momentum_and_energy() -> None:
    found = strike(
        oblique(
            **SMALL | {"plate__radius": 0.01},
            plate__edge="free",
            outer__offset=4e-3,
            outer__angle=0.6,
            outer__speed=3.0,
            friction=0.3,
            run={"end_time": 3e-5},
        )
    )
    run = found.run
    assert run.losses is not None and min(run.losses.contacts) > 0.0
    assert run.energy_residual < 1e-12
    assert run.momentum_residual < 1e-12
    assert abs(run.support_impulse) < 1e-12 * found.scene.outer.mass * found.scene.speed
    start, end = angular_momentum(found)
    assert end == pytest.approx(start, rel=2e-3)
    assert abs(found.spin) > 1.0


def clamped_modes(ratio: float, most: float) -> tuple[list[float], list[float]]:
    """Eigenvalues lambda < ``most`` of a clamped plate of radius 1, and the squares of its modes.

    Kirchhoff's plate: W = J_n(l r) - J_n(l)/I_n(l) I_n(l r) times cos(n phi), at r = ``ratio``,
    over the mean square of the mode (Leissa, Vibration of Plates, 1969, ch. 2).
    """
    values: list[float] = []
    shares: list[float] = []
    r = np.linspace(0.0, 1.0, 2001)
    # on the axis every mode with a nodal diameter is at rest
    for n in range(int(most) + 1 if ratio > 0.0 else 1):
        grid = np.linspace(max(0.5 * n, 1e-3), most, 800)

        def edge(x: Any, n: int = n) -> Any:
            return jv(n, x) * ivp(n, x) / iv(n, x) - jvp(n, x)

        found = edge(grid)
        for k in np.flatnonzero(found[:-1] * found[1:] < 0.0):
            x = brentq(edge, grid[k], grid[k + 1], xtol=1e-12)
            shape = jv(n, x * r) - jv(n, x) / iv(n, x) * iv(n, x * r)
            around = 1.0 if n == 0 else 0.5
            mean = 2.0 * around * float(trapezoid(shape**2 * r, r))
            values.append(x)
            shares.append(float(np.interp(ratio, r, shape)) ** 2 / mean)
    return values, shares


def modal_sum(scene: Scene, end: float) -> tuple[float, float]:
    """Velocity at the end (m/s) and largest force (N) of Hertz's contact with a Kirchhoff plate."""
    plate, ball = scene.plate, scene.outer
    values, shares = clamped_modes(scene.offset / plate.radius, 40.0)
    frequency = (np.array(values) / plate.radius) ** 2 * math.sqrt(
        plate.bending_stiffness / plate.surface_density
    )
    participation = np.sqrt(np.array(shares) / (plate.surface_density * math.pi * plate.radius**2))
    stiffness = hertz_stiffness(plate.material.plane_strain_modulus, ball.tip_radius)
    count = frequency.size

    def force(y: Any) -> float:
        return float(stiffness * max(participation @ y[2 : 2 + count] - y[0], 0.0) ** 1.5)

    def rate(_: float, y: Any) -> Any:
        f = force(y)
        q, p = y[2 : 2 + count], y[2 + count :]
        return np.concatenate([[y[1], f / ball.mass], p, -(frequency**2) * q - participation * f])

    start = np.zeros(2 + 2 * count)
    start[1] = -scene.normal_speed
    path = solve_ivp(rate, (0.0, end), start, rtol=1e-7, atol=1e-12, method="DOP853")
    return float(path.y[1, -1]), max(force(y) for y in path.y.T)


def test_a_plate_struck_off_its_centre_is_the_sum_of_its_modes() -> None:
    end = 6e-5
    found = strike(
        oblique(
            "both",
            2,
            1.0,
            plate__radius=0.012,
            plate__thickness=1e-3,
            outer__radius=4e-3,
            outer__speed=1.0,
            outer__offset=5e-3,
            inner__gap=1e-3,
            inner__radius=4e-3,
            run={"end_time": end},
        )
    )
    velocity, peak = modal_sum(found.scene, end)
    at_centre, _ = modal_sum(replace(found.scene, offset=0.0), end)
    found_velocity = found.run.outer_velocity / found.scene.speed
    assert abs(velocity - at_centre) > 0.15 * found.scene.speed
    assert found_velocity == pytest.approx(velocity / found.scene.speed, abs=0.01)
    assert found.run.contacts[0].force_peak == pytest.approx(peak, rel=0.06)
