"""Poses at which a root search is difficult: A4 near 0 and 180 degrees, a straight elbow, any offset."""

from dataclasses import dataclass

import numpy as np
import softkin

from tests.catalogue.search.arms import Array

ARM = {"d1": 400.0, "a1": 25.0, "a2": 455.0, "a3": 35.0, "d4": 420.0, "d6": 80.0}
OFFSETS = (1e-9, 1e-6, 1e-3, 0.5, 8.0, -35.0, 60.0, 150.0, -300.0)
KINDS = ("anywhere", "straight wrist", "elbow", "both")


@dataclass(frozen=True)
class Planted:
    """Axes of one machine, in rows, and references: near, zero or far."""

    robot: softkin.Ac6RZRYRYRXRYRZJ6Offset
    lateral: float
    axes: Array
    references: Array


def planted(kind: str, lateral: float, count: int, seed: int) -> Planted:
    """Poses of a kind; distances to what is singular of every decade from 1 to 1e-12 degrees."""
    rng = np.random.default_rng(seed)
    axes = rng.uniform(-180.0, 180.0, (count, 6))
    if kind in ("straight wrist", "both"):
        axes[:, 3] = rng.choice((0.0, 180.0, -180.0), count) + _distance(rng, count)
    if kind in ("elbow", "both"):
        straight = np.degrees(np.arctan2(ARM["d4"], -ARM["a3"]))
        axes[:, 2] = straight + rng.choice((0.0, 180.0), count) + _distance(rng, count)
    references = rng.uniform(-180.0, 180.0, (count, 6))
    chosen = rng.integers(0, 3, count)[:, None]
    near = axes + rng.uniform(-5.0, 5.0, (count, 6))
    references = np.where(chosen == 0, near, np.where(chosen == 1, 0.0, references))
    return Planted(softkin.Ac6RZRYRYRXRYRZJ6Offset(**ARM, j6_offset_x=lateral), lateral, axes, references)


def _distance(rng: np.random.Generator, count: int) -> Array:
    """Of either sign, every decade as often."""
    return np.asarray(10.0 ** rng.uniform(-12.0, 0.0, count) * rng.choice((-1.0, 1.0), count))
