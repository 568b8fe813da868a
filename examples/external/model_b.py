"""Model B of the paper: spheres on a clamped plate of 16 Kirchhoff modes, contacts of Hertz.

Reads the question of impactcheck on standard input, answers on standard output: quantities and
curves in SI, signed along z (from the inner to the outer body). What is not stated is read off
the curves.
"""

import json
import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import i0, i1, j0, j1

MODES = 16
END_TIME = 250e-6

question = json.load(sys.stdin)
plate, outer, inner = (question["scene"][part] for part in ("plate", "outer", "inner"))
assert plate["edge"] == "clamped", "this model knows clamped plates only"

# modes w(r) = J0(k r/R) - J0(k)/I0(k) I0(k r/R), for which the integral of w^2 r dr is J0(k)^2 R^2
steel, radius, thickness = plate["material"], plate["radius"], plate["thickness"]
roots = [
    brentq(lambda k: j0(k) * i1(k) + i0(k) * j1(k), m * np.pi - 0.5, m * np.pi + 0.5, xtol=1e-13)
    for m in range(1, MODES + 1)
]
k = np.array(roots)
area_mass = steel["density"] * thickness
rigidity = steel["youngs_modulus"] * thickness**3 / (12 * (1 - steel["poisson_ratio"] ** 2))
omega = k**2 / radius**2 * np.sqrt(rigidity / area_mass)
centre = (1 - j0(k) / i0(k)) / np.sqrt(2 * np.pi * radius**2 * area_mass * j0(k) ** 2)


def sphere(body):
    """Mass in kg and Hertz's stiffness against the plate in N/m^1.5."""
    material = body["material"]
    compliance = sum((1 - m["poisson_ratio"] ** 2) / m["youngs_modulus"] for m in (material, steel))
    mass = material["density"] * 4 / 3 * np.pi * body["radius"] ** 3
    return mass, 4 / 3 * np.sqrt(body["radius"]) / compliance


(outer_mass, outer_stiffness), (inner_mass, inner_stiffness) = sphere(outer), sphere(inner)


def forces(z_outer, z_inner, w):
    """Contact forces in N, positive in compression, from the positions in m along z."""
    return (
        outer_stiffness * np.maximum(w - z_outer, 0) ** 1.5,
        inner_stiffness * np.maximum(z_inner - w, 0) ** 1.5,
    )


def rate(_, state):
    """Rate of the state: positions of outer body, inner body and modes, then velocities."""
    z, v = np.split(state, 2)
    above, below = forces(z[0], z[1], centre @ z[2:])
    modal = centre * (below - above) - omega**2 * z[2:]
    return np.concatenate([v, [above / outer_mass, -below / inner_mass], modal])


start = np.zeros(2 * (MODES + 2))
start[1], start[MODES + 2 : MODES + 4] = -inner["gap"], [-outer["speed"], inner.get("speed", 0.0)]
times = np.arange(0, END_TIME, question["sample_interval"])
run = solve_ivp(rate, (0, times[-1]), start, "DOP853", times, rtol=1e-9, atol=1e-13)
z, v = np.split(run.y, 2)
above, below = forces(z[0], z[1], centre @ z[2:])
history = {
    "time": times,
    "outer_displacement": z[0],
    "inner_displacement": z[1] - z[1][0],
    "plate_displacement": centre @ z[2:],
    "outer_velocity": v[0],
    "inner_velocity": v[1],
    "plate_velocity": centre @ v[2:],
    "outer_force": above,
    "inner_force": below,
}
answer = {"schema_version": 1, "modes": MODES, "first_frequency": omega[0] / (2 * np.pi)}
answer["history"] = {name: list(curve) for name, curve in history.items()}
json.dump(answer, sys.stdout)
