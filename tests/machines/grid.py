"""Where machines are asked: at right angles and anywhere."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from tests.machines.made import Array, Made

MOST = 300
"""Rows of a grid, drawn where it has more."""


def grid(machine: Made) -> Array:
    """Joints at multiples of a quarter turn and of a length, where every singular pose is, and anywhere."""
    rng = np.random.default_rng(4)
    angles, slides = (-180.0, -90.0, 0.0, 90.0, 180.0), (-0.5, 0.0, 0.3)
    rows = np.array(list(product(*[angles if a else slides for a in machine.closure.angles])))
    if len(rows) > MOST:
        rows = rows[rng.choice(len(rows), MOST, replace=False)]
    sizes = np.where(machine.closure.angles, 200.0, 0.9)
    return machine.axes(np.concatenate([rows, rng.uniform(-1.0, 1.0, (100, rows.shape[1])) * sizes]))


def is_own(machine: Made, axes: Array) -> NDArray[np.bool_]:
    """Whether every positive quantity of the machine is."""
    return np.all(machine.closure.positive(machine.closure.joints(axes)) > 1e-6, axis=1)


def margins(machine: Made, axes: list[float]) -> list[float]:
    """The singularity margins at axis values."""
    return list(machine.robot.singularity(axes).margins.values())
