"""The memory of `inverse_all_batch`: from 100,000 rows on little more than its result."""

import tracemalloc

import numpy as np
import pytest
from numpy.typing import ArrayLike
from softkin import Mechanism

from tests.catalogue.calls.mountings import NAMES, machines, mounted, poses, radian, robots
from tests.mechanisms import catalogue

pytestmark = pytest.mark.broad

MANY = 100_000
MOST = 1.3
SLOW = tuple(m.name for _, m in catalogue() if m.is_platform or m.search)
"""Machines of which one row takes long."""


def on_the_way(robot: Mechanism, poses: ArrayLike, rows: int) -> tuple[float, float]:
    """The bytes of the result, and those of everything else at the peak. poses: axis values, which are repeated."""
    axes = np.atleast_2d(poses)
    positions, rotations = (np.resize(part, (rows, *part.shape[1:])) for part in robot.forward_batch(axes)[:2])
    near = np.resize(axes, (rows, len(robot.AXES)))
    robot.inverse_all_batch(positions[:9], rotations[:9], near[:9])
    tracemalloc.start()
    try:
        found = robot.inverse_all_batch(positions, rotations, near)
        size = float(sum(part.nbytes for part in found))
        return size, tracemalloc.get_traced_memory()[1] - size
    finally:
        tracemalloc.stop()


@pytest.mark.long("Pos_RRR", "Scara4")
@pytest.mark.parametrize("name", [n for n in NAMES if n not in SLOW])
def test_the_peak_is_hardly_more_than_the_result(name: str) -> None:
    """Traced, without the input."""
    size, more = on_the_way(robots(name)[0].made, poses(name, 0, 3), MANY)
    assert size + more <= MOST * size


@pytest.mark.long
@pytest.mark.parametrize(
    "name", ["Kin_ArticulatedRobot_6DOF", "Kin_Scara4_ZCcoupled_Type1", "Kin_Gantry3", "scara, wrist"]
)
def test_with_base_and_tool_it_is_no_more(name: str) -> None:
    """In radians, too."""
    bare, axes, _ = machines(name)[0]
    for robot, near in ((mounted(bare), axes), (mounted(bare).in_radians(), radian(bare, axes))):
        size, more = on_the_way(robot, near, MANY)
        assert size + more <= MOST * size


@pytest.mark.long
@pytest.mark.parametrize("name", SLOW)
def test_few_rows_are_taken_at_once(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """As many rows together as of a batch of 100,000, in a shorter one: what is on the way stays."""
    from softkin import _batch

    robot = robots(name)[0].made
    together = _batch._rows_together(robot._array_programs().VALUES, MANY, 2**robot.BRANCHES, len(robot.AXES))
    monkeypatch.setattr(_batch, "_rows_together", lambda *given: together)
    size, more = on_the_way(robot, poses(name, 0, 3), 3 * together)
    assert more <= (MOST - 1.0) * size / (3 * together) * MANY
