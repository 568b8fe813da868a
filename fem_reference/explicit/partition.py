"""Which process owns which element: as many of every level for each, few nodes in common."""

from __future__ import annotations

import numpy as np

from ..common.arrays import Floats, Ints, Mask
from .levels import MOST_LEVELS, graded_levels

EXPECTED = 1.2
"""Critical time step of a system over the smallest of its elements, about."""
CONTACT = 1.0
"""Work of contact per element at nodes that can touch, over that of an element."""
SLACK = 0.02
"""Share of a level that a part may have more or less of, so that its border is smoother."""


def owners(
    points: Floats, elements: Ints, steps: Floats, contact_nodes: Ints, processes: int
) -> Ints:
    """(m,) process of each element; those at nodes that can touch are all the first one's.

    Meshes grow away from the contacts, so the parts are cones and sectors from there: cut in two
    again and again along that direction or angle in which the fewest nodes lie on the cut.

    Args:
        points: (n, 3) m.
        elements: (m, k) nodes.
        steps: (m,) critical time step of each element, s.
        contact_nodes: nodes that can be in contact.
        processes: how many.
    """
    near = np.zeros(points.shape[0], dtype=bool)
    near[contact_nodes] = True
    level = graded_levels(steps / (EXPECTED * steps.min()), elements, near, MOST_LEVELS)
    groups = np.where(near[elements].any(axis=1), -1, level)
    centres = points[elements[:, :4]].mean(axis=1)
    away = centres - points[contact_nodes if contact_nodes.size else slice(None)].mean(axis=0)
    direction = away / np.maximum(np.linalg.norm(away, axis=1), 1e-300)[:, None]
    angle = np.arctan2(away[:, [1, 2, 2]], away[:, [0, 1, 0]])
    owner = np.zeros(elements.shape[0], dtype=np.int64)
    every = np.arange(owner.size)
    _halve(owner, every, range(processes), (*direction.T, *angle.T), groups, elements)
    return owner


def _halve(
    owner: Ints,
    among: Ints,
    ranks: range,
    fields: tuple[Floats, ...],
    groups: Ints,
    elements: Ints,
) -> None:
    """Share out the elements ``among`` among ``ranks``; those of group -1 go to the first."""
    if len(ranks) == 1:
        owner[among] = ranks[0]
        return
    half = len(ranks) // 2
    cuts = [_lower(field[among], groups[among], half / len(ranks)) for field in fields]

    def in_common(lower: Mask) -> int:
        sides = np.zeros((2, int(elements.max()) + 1), dtype=bool)
        sides[0, elements[among[lower]]] = True
        sides[1, elements[among[~lower]]] = True
        return int(np.count_nonzero(sides.all(axis=0)))

    lower = min(cuts, key=in_common)
    _halve(owner, among[lower], ranks[:half], fields, groups, elements)
    _halve(owner, among[~lower], ranks[half:], fields, groups, elements)


def _lower(field: Floats, groups: Ints, share: float) -> Mask:
    """The ``share`` with the lower values; of every level as much, but for `SLACK`.

    What group -1 costs more, at every step, the next levels have less, which act less often.
    """
    lower = groups < 0
    owed = (1.0 - share) * (1.0 + CONTACT) * np.count_nonzero(lower)
    cut = float(np.quantile(field, share))
    for number in np.unique(groups[groups >= 0]):
        members = groups == number
        size = np.count_nonzero(members)
        given = min(2.0**number * owed, share * size)
        owed -= given / 2.0**number
        target = share - given / size
        least, most = np.quantile(
            field[members], [max(0.0, target - SLACK), min(1.0, target + SLACK)]
        )
        lower[members] = field[members] <= min(max(cut, least), most)
    return lower
