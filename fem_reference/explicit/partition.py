"""Which process owns which node: as many of every level for each, few neighbours in others."""

from __future__ import annotations

import numpy as np

from ..common.arrays import Floats, Ints, Mask

CLASSES_PER_OCTAVE = 2
"""Nodes are shared out evenly in every class of time steps so wide: so they are in every level,
whatever the levels will be."""


def owners(points: Floats, elements: Ints, steps: Floats, touching: Ints, processes: int) -> Ints:
    """(n,) process of each node; nodes that can touch are all the first one's.

    Meshes grow away from the contacts, so the parts are cones from there, cut in two again and
    again along that coordinate of the direction which fewest elements straddle.

    Args:
        points: (n, 3) m.
        elements: (m, k) nodes.
        steps: (m,) critical time step of each element, s.
        touching: nodes that can touch.
        processes: how many.
    """
    owner = np.zeros(points.shape[0], dtype=np.int64)
    if processes == 1:
        return owner
    fastest = np.full(points.shape[0], np.inf)
    for corner in elements.T:
        np.minimum.at(fastest, corner, steps)
    fastest[touching] = 0.0
    classes = np.zeros(points.shape[0], dtype=np.int64)
    classes[fastest > 0.0] = 1 + np.floor(
        CLASSES_PER_OCTAVE * np.log2(fastest[fastest > 0.0] / steps.min())
    ).astype(np.int64)
    centre = points[touching].mean(axis=0) if touching.size else points.mean(axis=0)
    away = points - centre
    direction = away / np.maximum(np.linalg.norm(away, axis=1), 1e-300)[:, None]
    _halve(owner, np.arange(points.shape[0]), range(processes), direction, classes, elements)
    return owner


def _halve(
    owner: Ints, nodes: Ints, ranks: range, direction: Floats, classes: Ints, elements: Ints
) -> None:
    """Share out ``nodes`` among ``ranks``; those of class 0 go to the first."""
    if len(ranks) == 1:
        owner[nodes] = ranks[0]
        return
    half = len(ranks) // 2
    share = half / len(ranks)
    cuts = [_lower(direction[nodes, axis], classes[nodes], share) for axis in range(3)]
    straddling = []
    for lower in cuts:
        side = np.zeros(owner.size, dtype=np.int64)
        side[nodes] = np.where(lower, 1, 2)
        on = side[elements]
        straddling.append(np.count_nonzero((on == 1).any(axis=1) & (on == 2).any(axis=1)))
    lower = cuts[int(np.argmin(straddling))]
    _halve(owner, nodes[lower], ranks[:half], direction, classes, elements)
    _halve(owner, nodes[~lower], ranks[half:], direction, classes, elements)


def _lower(along: Floats, classes: Ints, share: float) -> Mask:
    """The lower ``share`` of every class; what class 0 takes more is taken from the next ones."""
    lower = classes == 0
    owed = (1.0 - share) * np.count_nonzero(lower)
    for number in np.unique(classes[classes > 0]):
        members = np.flatnonzero(classes == number)
        wanted = share * members.size
        given = min(owed, wanted)
        owed -= given
        order = members[np.argsort(along[members], kind="stable")]
        lower[order[: round(wanted - given)]] = True
    return lower
