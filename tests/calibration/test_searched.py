"""A searched machine with deviations: next to where branches meet, the drawing may have a solution on another one."""

from collections.abc import Mapping

import numpy as np
import softkin

from tests.calibration.test_true_machine import lost
from tests.catalogue.search.planted import ARM

EQUAL = {**ARM, "a1": 0.0, "a2": 420.0, "a3": 0.0}
RIGHT_ANGLES = (180.0, -89.999999, -90.0, -180.0, 179.99999999999, 0.0)
"""Axes at which the links are one behind the other and the wrist is straight: from no solution of the drawing, nor from
one next to it, do steps lead to the pose on its branch.
"""


def measured(sizes: Mapping[str, float], rng: np.random.Generator) -> softkin.Mechanism:
    """An arm whose wrist is almost spherical, with deviations of 5 mrad and 5 mm."""
    nominal = softkin.Ac6RZRYRYRXRYRZJ6Offset(**sizes, j6_offset_x=1.0)
    names = nominal.deviations
    most = {n: 5.0 if "shift" in n or n[-2:] in ("_x", "_y", "_z") and "tilt" not in n else 0.28 for n in names}
    given = {n: float(size * rng.uniform(-1.0, 1.0)) for n, size in most.items() if not n.endswith("gain")}
    return nominal.calibrated(given)


def test_a_pose_that_the_drawing_has_on_another_branch() -> None:
    """None of the poses is lost."""
    rng = np.random.default_rng(4)
    robot = measured(ARM, rng)
    assert lost(robot, [tuple(row) for row in rng.uniform(-180.0, 180.0, (20, 6)).tolist()]) == []


def test_a_pose_next_to_no_solution_of_the_drawing() -> None:
    assert lost(measured(EQUAL, np.random.default_rng(4)), [RIGHT_ANGLES]) == []
