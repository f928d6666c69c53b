"""Where branches meet and angles are free, and close to there, the twins still answer the same."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import pytest

from tests.execution.comparisons import COMPARISONS
from tests.execution.controller import OK
from tests.execution.samples import NO_TURN, Sample, near
from tests.execution.twins import Twins

MACHINES = ("equal", "random 1")
"""With equal links every singular pose exists; with random offsets none of them is at a round number."""
METHODS = ("AxesToCartesian", "CartesianToAxes", "AxesToOrientation", "IsSingularity", "Jacobian")
OFFSET_METHODS = ("AxesToConfiguration_Offset", "CartesianToAxes_Offset")
EVERY = 7
"""The share of the grid at which the slower comparisons are made."""


@pytest.mark.parametrize("label", MACHINES)
def test_quarter_turns(twins: tuple[Twins, ...], label: str) -> None:
    (one,) = (t for t in twins if t.machine.label == label)
    assert len(one.grid) >= 9
    for sample in one.grid if label == "equal" else one.grid[::3]:
        for method in METHODS:
            COMPARISONS[method](one, sample)


@pytest.mark.parametrize("label", MACHINES)
def test_near_quarter_turns(twins: tuple[Twins, ...], label: str) -> None:
    (one,) = (t for t in twins if t.machine.label == label)
    for sample in near(one.grid[::EVERY]):
        for method in METHODS:
            COMPARISONS[method](one, sample)


@pytest.mark.parametrize("label", MACHINES)
def test_a_point_off_the_flange_at_quarter_turns(twins: tuple[Twins, ...], label: str) -> None:
    (one,) = (t for t in twins if t.machine.label == label)
    for sample in (*one.grid[::EVERY], *near(one.grid[::EVERY])):
        for method in OFFSET_METHODS:
            if method.lower() in one.controller.block.routines:
                COMPARISONS[method](one, sample)


def test_a_point_on_the_axis_of_a_link_cannot_be_aimed(twins: tuple[Twins, ...]) -> None:
    """The effective link of the offset interface is then too short to have a direction."""
    for one in twins:
        if "cartesiantoaxes_offset" not in one.controller.block.routines:
            continue
        for sample in one.regular[:5]:
            for offset in fixed_points(one, sample):
                COMPARISONS["CartesianToAxes_Offset"](one, replace(sample, offset=offset))


def fixed_points(one: Twins, sample: Sample) -> Iterator[tuple[float, ...]]:
    """For every rotary axis, the point of the flange about which it turns the flange."""
    jacobian, rotation = one.robot.jacobian(sample.axes), one.robot.orientation(sample.axes)
    for index, joint in enumerate(one.mechanism.joints):
        if joint.is_angle:
            arm = (-jacobian[1][index], jacobian[0][index], 0.0)
            yield tuple(sum(row[i] * v for row, v in zip(rotation, arm, strict=True)) for i in range(3))


def test_a_tie_goes_to_the_first_branch(twins: tuple[Twins, ...]) -> None:
    """A point straight ahead, and a reference that is as far from one solution as from its mirror image."""
    one = twins[0]
    if not one.robot.BRANCHES:
        return
    count, size = len(one.mechanism.joints), len(one.robot.CONFIGURATION)
    point, nothing = (0.8 * one.machine.reach, 0.0, 0.0), (0.0,) * count
    first, opened = (1,) + (0,) * (size - 1), (0,) * size
    solvers = [partial(one.controller.inverse, point, NO_TURN)]
    if "cartesiantoaxes_offset" in one.controller.block.routines:
        solvers.append(partial(one.controller.inverse_offset, point, (0.0, 0.0, 0.0)))
    for solve in solvers:
        assert solve(first, nothing)[0] == OK
        assert solve(first, nothing) == solve(opened, nothing) != solve((2, *first[1:]), nothing)


def test_the_grid_has_singular_poses(twins: tuple[Twins, ...]) -> None:
    """A mechanism with margins is singular somewhere on the grid, and not everywhere."""
    (equal,) = (t for t in twins if t.machine.label == "equal")
    found = [equal.controller.is_singular(sample.axes) for sample in equal.grid]
    assert any(found) == bool(equal.robot.MARGINS)
    assert not all(found)
