"""Scenes of a sphere in a seal seat that an actuator strikes from below.

Lengths are drawn as multiples of the sphere's radius. What has to fit follows from what was drawn:
bore, ring, island and membrane are built up from the inside to the outside.
"""

from __future__ import annotations

import math

from points import Point, Table, between

ELEMENTS = 16.0
"""Across the radius of the contact ring at `paper` resolution; below 5 the coarsest mesh has too
few nodes on the ring."""
INTENDED = math.radians(15.0)
"""Direction of the flight, which changes nothing that is compared."""


def seat(point: Point) -> Table:
    """An island with two seats on a membrane, and one or two tips."""
    radius = point.log(0.5e-3, 3e-3)
    half = math.radians(point.uniform(48.0, 64.0))
    tilt = math.radians(point.uniform(4.0, 20.0))
    sin, cos = math.sin(tilt), math.cos(tilt)
    ring, below = radius * math.cos(half), radius * math.sin(half)
    bore = ring * point.uniform(0.5, 0.85)
    # the bore ends below the cone, and below the sphere
    mouth = below + (ring - bore) / math.tan(half)
    depth = max(mouth, radius) + radius * point.uniform(0.1, 0.3)
    membrane = radius * point.log(0.12, 0.35)
    centre = membrane + radius * point.uniform(0.05, 0.6) + depth * cos + bore * sin
    # the ring leans inwards: its outermost point is its highest one
    highest = centre - below * cos + ring * sin
    height = highest + radius * point.uniform(0.15, 0.5)
    web = radius * point.uniform(0.5, 1.4)
    distance = 2.0 * (web + ring * cos - below * sin)
    # the cones leave the island through its top
    rise = height - highest
    margin = radius * point.uniform(0.2, 0.6)
    outermost = web + 2.0 * ring * cos + rise * math.tan(half - tilt)
    across = ring + (rise + ring * sin) / cos * math.tan(half)
    length, width = 2.0 * (outermost + margin), 2.0 * (across + margin)
    rim = 0.5 * math.hypot(length, width) + membrane * point.log(3.0, 12.0)
    material = {
        "youngs_modulus": point.log(1e9, 10e9),
        "poisson_ratio": point.uniform(0.3, 0.42),
        "density": point.log(1000.0, 2000.0),
    }
    density = material["density"] * point.log(1.5, 6.0)
    mass = 4.0 / 3.0 * math.pi * radius**3 * density * point.log(2.0, 30.0)
    speed = math.sqrt(material["youngs_modulus"] / material["density"]) * point.log(1e-4, 1.5e-3)
    tip_radius = radius * point.log(1.0, 4.0)
    pair = point.one_of("one", "pair") == "pair"
    tip = 0.5 * length * (point.uniform(0.4, 0.9) if pair else point.uniform(-0.5, 0.5))
    scene: Table = {
        "kind": "seal-seat",
        "materials": {
            "seat": material,
            "sphere": {"youngs_modulus": 210e9, "poisson_ratio": 0.3, "density": density},
        },
        "seat": {
            "material": "seat",
            "membrane_radius": rim,
            "membrane_thickness": membrane,
            "island_length": length,
            "island_width": width,
            "island_height": height,
            "seat_distance": distance,
            "seated_height": centre,
            "tilt": tilt,
            "aperture_angle": 2.0 * half,
            "bore_radius": bore,
            "bore_depth": depth,
        },
        "sphere": {"radius": radius, "material": "sphere"},
        "actuator": {
            "mass": mass,
            "speed": speed,
            "tip_radius": tip_radius,
            "tip_positions": [-tip, tip] if pair else [tip],
        },
        "intended": {"angle": INTENDED},
        "reference": {"elements_per_ring_radius": ELEMENTS},
    }
    if notch := point.some(0.4, between(0.2, 0.7)):
        lowest = highest - 2.0 * ring * sin
        floor = membrane + (lowest - membrane) * point.uniform(0.1, 0.6)
        scene["seat"] |= {"notch_width": 2.0 * notch * web, "notch_floor": floor}
    return scene
