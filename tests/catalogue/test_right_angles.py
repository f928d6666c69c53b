"""A grid of all axis values at multiples of 90 degrees: where formulas that look right divide by zero."""

from itertools import product

import numpy as np
import pytest
from softkin import Status

from tests.catalogue.both_ways import inverse
from tests.catalogue.closure import Array
from tests.catalogue.machines import Machine, machine
from tests.catalogue.references import held_at
from tests.catalogue.refusals import refusal
from tests.catalogue.shares import share
from tests.catalogue.test_round_trip import slots

pytestmark = pytest.mark.serial

ANGLES = tuple(90.0 * k for k in range(-4, 5))
ONE_TURN = (-90.0, 0.0, 90.0, 180.0)
"""Of a machine with so many axes that more turns would be too many."""
MANY = 5
LABELS = ("plain", "nominal", "equal", "unequal", "offset")
REGULAR, SINGULAR = 1e-12, 1e-10
AXES, STRETCHED = 1e-9, 1e-4
"""Degrees: at a stretched arm half of the digits of the elbow are lost, and none of the frame's."""


@pytest.fixture(params=LABELS)
def grid(request: pytest.FixtureRequest, machines: tuple[Machine, ...]) -> tuple[Machine, Array]:
    """A machine, and every combination of right angles; linear axes behind, in and before their zero."""
    label = request.param
    if label == "offset":
        base = machines[1]
        offsets = {f"offset_{j.key}": 90.0 * (i + 1) for i, j in enumerate(base.mechanism.joints)}
        chosen = machine(base.mechanism, label, {**base.given, **offsets})
    else:
        (chosen,) = (m for m in machines if m.label == label)
    lengths = (-chosen.reach / 2, 0.0, chosen.reach)
    angles = ANGLES if chosen.closure.angles.sum() < MANY else ONE_TURN
    values = [angles if j.is_angle else lengths for j in chosen.mechanism.joints]
    return chosen, np.array(list(product(*values))) + np.where(chosen.closure.angles, 0.0, chosen.closure.offsets)


def possible(chosen: Machine, axes: Array) -> Array:
    """Which rows the machine has: no negative radius, no polar angle beyond the vertical."""
    inside = np.ones(len(axes), dtype=bool)
    for i, joint in enumerate(chosen.mechanism.joints):
        low, high = joint.domain or (-np.inf, np.inf)
        motor = axes[:, i] - chosen.closure.offsets[i]
        inside &= (motor >= low) & (motor <= high)
    return inside


def test_forward_answers_where_there_is_a_pose(grid: tuple[Machine, Array]) -> None:
    chosen, axes = grid
    positions, rotations, _, statuses = chosen.robot.forward_batch(axes)
    inside = possible(chosen, axes)
    assert (statuses[inside] == Status.OK).all()
    assert (statuses[~inside] == Status.IMPOSSIBLE).all()
    assert chosen.error(axes[inside], positions[inside], rotations[inside]).max() < REGULAR
    for row in axes[~inside][:50]:
        assert refusal(chosen.robot.forward, row) is Status.IMPOSSIBLE
        assert chosen.robot.singularity(row).is_singular


def test_every_pose_goes_round(grid: tuple[Machine, Array]) -> None:
    """Inverse with the reported configuration, and the same axes as reference where something is free."""
    chosen, axes = grid
    axes = axes[possible(chosen, axes)]
    frames = chosen.closure.poses(axes)
    configurations = chosen.robot.forward_batch(axes)[2]
    found, statuses = chosen.robot.inverse_batch(*frames, configurations, axes)
    some = slice(None, None, 1 + len(axes) // 25)
    inverse(chosen.robot, frames[0][some], frames[1][some], configurations[some], axes[some])
    assert (statuses == Status.OK).all()
    regular = chosen.is_regular(axes)
    assert chosen.miss(found, *frames)[regular].max(initial=0.0) < REGULAR
    assert chosen.miss(found, *frames).max() < SINGULAR
    assert np.abs(found - axes)[regular].max(initial=0.0) < AXES
    turned = chosen.closure.angles & np.array([j.multi_turn for j in chosen.mechanism.joints])
    apart = found - axes - np.where(turned, 360.0 * np.round((found - axes) / 360.0), 0.0)  # at the end of a turn
    # where several singularities coincide, half of the digits of one angle decide whether another is free
    several = (configurations[:, : chosen.robot.BRANCHES] == 3).sum(axis=1) > 1
    assert np.abs(apart)[~several][:, chosen.closure.angles].max(initial=0.0) < STRETCHED
    assert (chosen.robot.forward_batch(found)[2] == configurations)[regular].all()


@pytest.mark.slow("ThreeParallel")
def test_every_pose_is_solved_on_every_slot(grid: tuple[Machine, Array]) -> None:
    """At right angles every slot that answers reaches the pose, and at least one slot answers."""
    chosen, axes = grid
    axes = axes[possible(chosen, axes)]
    axes = axes[share(len(axes))]
    frames = chosen.closure.poses(axes)
    robot = chosen.changed(check_limits=False)
    answers = np.zeros(len(axes), dtype=int)
    for slot in slots(chosen):
        found, statuses = robot.inverse_batch(*frames, slot + (0,) * len(robot.PERIOD_AXES), held_at(robot, axes))
        answered = chosen.answers(statuses)
        answers += answered
        assert chosen.miss(found[answered], *(f[answered] for f in frames)).max(initial=0.0) < SINGULAR
    assert (answers >= 1).all()
