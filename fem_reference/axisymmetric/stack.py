"""Finite elements of a piezo stack: a round rod under the stress of a uniform field.

Bilinear elements with incompatible modes, u_z = 0 at the base, where the rod may widen. A stiff
cap without mass closes the other end: its nodes are one, which has the spherical tip. The piezo
stress is uniform, so that all of its load stands on base and cap.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..common.arrays import Floats, Ints
from ..common.bodies import Stack
from ..common.errors import SceneError
from ..explicit import structures
from .elasticity import BodyMatrices, assemble, global_matrix
from .elements import ElementMatrices
from .mesh import BodyMesh

ACROSS = 12
"""Elements across the radius at `paper` resolution, as long as they are wide."""
SHARE = 0.2
"""Of the critical time step, with which the stack comes to the plate."""
LONGEST = 40.0
"""Times length over wave speed within which the tip has to come there."""


@dataclass(frozen=True)
class FirstContact:
    """The stack when its tip touches the plate."""

    time: float
    """Since it was switched on, s."""
    displacement: Floats
    """(n, 2) m"""
    velocity: Floats
    """(n, 2) m/s"""
    charge: float
    """C"""
    work: float
    """Of the voltage on the body so far, J."""
    heat: float
    """In the resistor so far, J."""


@dataclass(frozen=True)
class StackBody:
    """The elements of a stack that pushes its tip towards -z."""

    stack: Stack
    across: int
    """Elements across the radius."""

    @property
    def along(self) -> int:
        """Elements along the length."""
        return max(2, round(self.across * self.stack.length / self.stack.radius))

    @property
    def count(self) -> int:
        """Nodes; the last one is the cap."""
        return self.along * (self.across + 1) + 1

    @property
    def base(self) -> Ints:
        """Nodes at the base."""
        return np.arange(self.across + 1)

    @property
    def fixed(self) -> Ints:
        """Components (2 * node + component)."""
        axis = np.arange(self.along) * (self.across + 1)
        return np.concatenate([2 * axis, 2 * self.base + 1, [2 * (self.count - 1)]])

    @cached_property
    def matrices(self) -> BodyMatrices:
        """Of all nodes."""
        stack, columns = self.stack, self.across + 1
        r, z = np.meshgrid(
            np.linspace(0.0, stack.radius, columns),
            np.linspace(stack.length, 0.0, self.along + 1),
        )
        corner = (np.arange(self.along)[:, None] * columns + np.arange(self.across)).ravel()
        quads = np.stack([corner + columns, corner + columns + 1, corner + 1, corner], axis=1)
        mesh = BodyMesh("stack", np.stack([r.ravel(), z.ravel()], axis=1), quads)
        elements = assemble(mesh, stack.ceramic).elements
        nodes = np.minimum(elements.nodes, self.count - 1)
        mass = np.bincount(nodes.ravel(), elements.mass.ravel(), minlength=self.count)
        return BodyMatrices(
            global_matrix(nodes, elements.stiffness, self.count),
            np.asarray(mass, dtype=np.float64),
            ElementMatrices(nodes, elements.stiffness, elements.mass),
        )

    @cached_property
    def first_contact(self) -> FirstContact:
        """Switched on at rest, when the tip has come as far as the plate.

        Raises:
            SceneError: it does not come there.
        """
        stack, still = self.stack, np.zeros((self.count, 2))
        if stack.gap == 0.0:
            return FirstContact(0.0, still, still, 0.0, 0.0, 0.0)
        matrices, supply, tip = self.matrices, stack.drive, 2 * self.count - 1
        inverse = np.repeat(1.0 / matrices.mass, 2)
        inverse[self.fixed] = 0.0
        step = SHARE * float(matrices.elements.critical_time_steps().min())
        alpha, capacitance = stack.force_per_voltage, stack.clamped_capacitance

        def moved(
            state: tuple[Floats, Floats, float], dt: float
        ) -> tuple[Floats, Floats, float, float, float]:
            """Velocity Verlet and the trapezoidal rule; also work and heat."""
            u, v, charge = state

            def rate(u: Floats, charge: float) -> Floats:
                force = -(matrices.stiffness @ u)
                force[tip] -= self.force(u[tip], charge)
                return np.asarray(inverse * force)

            half = v + 0.5 * dt * rate(u, charge)
            after, heat, taken = u + dt * half, 0.0, charge
            if supply is not None:
                change = 0.5 * dt * (supply.elastance + 1.0 / capacitance) / supply.resistance
                mean = -0.5 * (u[tip] + after[tip])
                fed = (stack.voltage + alpha * mean / capacitance) / supply.resistance
                taken = ((1.0 - change) * charge + dt * fed) / (1.0 + change)
                heat = supply.resistance * (taken - charge) ** 2 / dt
            force = 0.5 * (self.force(u[tip], charge) + self.force(after[tip], taken))
            work = force * (u[tip] - after[tip])
            return after, half + 0.5 * dt * rate(after, taken), taken, work, heat

        u, v, charge, time, work, heat = still.ravel(), still.ravel(), 0.0, 0.0, 0.0, 0.0
        slow = 0.0 if supply is None else 10.0 * supply.resistance * stack.capacitance
        while time < LONGEST * stack.stroke / stack.step_speed + slow:
            share, after = 1.0, moved((u, v, charge), step)
            if -after[0][tip] >= stack.gap:
                low, high = 0.0, 1.0
                for _ in range(60):
                    share = 0.5 * (low + high)
                    after = moved((u, v, charge), share * step)
                    low, high = (low, share) if -after[0][tip] >= stack.gap else (share, high)
                work, heat = work + after[3], heat + after[4]
                shape = (self.count, 2)
                return FirstContact(
                    *(time + share * step, after[0].reshape(shape), after[1].reshape(shape)),
                    *(after[2], work, heat),
                )
            u, v, charge = after[:3]
            time, work, heat = time + step, work + after[3], heat + after[4]
        raise SceneError(
            f"outer.gap is {stack.gap:g} m, but the stack's tip does not come there within "
            f"{time:.3g} s"
        )

    def force(self, tip: float, charge: float) -> float:
        """Of the voltage on the tip, whose displacement along z is ``tip`` (m), N."""
        stack = self.stack
        if stack.drive is None:
            return stack.blocked_force
        alpha = stack.force_per_voltage
        return alpha * (charge + alpha * tip) / stack.clamped_capacitance

    def voltage(self, node: int) -> structures.Voltage:
        """For the time loop, from the touch on; ``node`` of the cap in the system."""
        stack, supply, made = self.stack, self.stack.drive, structures.Voltage()
        made.node, made.force_per_voltage = node, stack.force_per_voltage
        made.capacitance, made.source = stack.clamped_capacitance, stack.voltage
        if supply is not None:
            made.resistance, made.elastance = supply.resistance, supply.elastance
        made.charge = self.first_contact.charge
        return made

    def taken(self, voltage: structures.Voltage, extension: float) -> float:
        """Energy that buffer or source have lost, J; ``extension`` of the tip, m."""
        stack = self.stack
        if stack.drive is None:
            charge = stack.clamped_capacitance * stack.voltage + stack.force_per_voltage * extension
            return stack.voltage * charge
        charge = float(voltage.charge)
        return stack.voltage * charge - 0.5 * stack.drive.elastance * charge**2
