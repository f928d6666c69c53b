"""Random axis values, drawn here for all tests: all over, but where a loop closes if one moves the joint."""

from __future__ import annotations

import numpy as np
import softkin
from numpy.random import Generator
from numpy.typing import ArrayLike

from tests.catalogue.closure import Array
from tests.catalogue.driven_machines import DRIVEN, DrivenClosure, reach_of

DESCRIBED = {mechanism.name: mechanism for mechanism in DRIVEN}


def random_axes(
    robot: softkin.Mechanism,
    count: int,
    rng: Generator,
    turn: float = 170.0,
    slide: float = 300.0,
    about: ArrayLike = 0.0,
) -> Array:
    """Rows of axis values: up to `turn` degrees and `slide` lengths on both sides of a middle."""
    sizes = np.where([axis.unit == "deg" for axis in robot.AXES], turn, slide)
    rows = about + rng.uniform(-1.0, 1.0, (count, len(sizes))) * sizes
    if (mechanism := DESCRIBED.get(robot.NAME)) is None:
        return rows
    return DrivenClosure(mechanism, robot.parameters, reach_of(mechanism, robot)).closed(rows, rng)
