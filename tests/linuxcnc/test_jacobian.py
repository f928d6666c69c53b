"""Rates of joints by rates of the pose: by perturbed joints, and by differences of the inverse."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest

from tests.linuxcnc.machine import NAMES, Array, Axes, Machine, machine_of, regular
from tests.linuxcnc.module import LETTERS, MOST_JOINTS, Module, Pose
from tests.mechanisms import named

STEP = 1e-4
"""Degrees and millimetres."""
POSES, LEAST = 4, 0.1


FOLLOWED = [name for name in NAMES if named(name).followed_turns]
"""Machines that follow a pitch: their poses have more letters than the Jacobian has rows."""


@pytest.mark.parametrize("name", [name for name in NAMES if name not in FOLLOWED])
def test_rates(name: str) -> None:
    """A joint that moves alone has the rate 1, the others 0; and the inverse moves as the columns say."""
    machine = machine_of(name)
    count = 0
    for axes, pose in islice(regular(machine, LEAST), POSES):
        machine.module.forward(axes)
        flags = machine.module.flags
        given = machine.module.jacobian(axes, pose)
        assert given is not None
        rows = np.array(given)
        assert rows.shape == (MOST_JOINTS, len(LETTERS)) and not rows[len(axes) :].any()
        unused = [i for i, letter in enumerate(LETTERS) if letter not in machine.words.letters]
        assert not rows[:, unused].any()
        rows = rows[: len(axes)]
        largest = 1.0 + np.abs(rows).max()
        assert np.allclose(rows @ by_joints(machine.module, axes, pose), np.eye(len(axes)), atol=1e-6 * largest)
        for k, column in by_letters(machine, axes, pose, flags):
            assert np.allclose(rows[:, k], column, atol=1e-5 * largest**2), LETTERS[k]
            count += 1
    assert count >= len(machine.words.letters)


def by_joints(module: Module, axes: Axes, pose: Pose) -> Array:
    """Rates of the pose by those of the joints: differences of forward kinematics."""
    columns = []
    for i in range(len(axes)):
        ends = []
        for step in (-STEP, STEP):
            moved = module.forward([v + (step if i == j else 0.0) for j, v in enumerate(axes)], pose)
            assert moved is not None
            ends.append([moved[letter] for letter in LETTERS])
        columns.append((np.array(ends[1]) - np.array(ends[0])) / (2.0 * STEP))
    return np.array(columns).T


def by_letters(machine: Machine, axes: Axes, pose: Pose, flags: int | None = None) -> list[tuple[int, Array]]:
    """Rates of the joints by those of each letter of the machine that can be moved there."""
    found = []
    for k, letter in enumerate(LETTERS):
        if letter not in machine.words.letters:
            continue
        ends = [machine.module.inverse(pose | {letter: pose[letter] + s}, axes, flags) for s in (-STEP, STEP)]
        if ends[0] is not None and ends[1] is not None:
            found.append((k, (np.array(ends[1]) - np.array(ends[0])) / (2.0 * STEP)))
    return found


@pytest.mark.parametrize("name", FOLLOWED)
def test_a_machine_that_follows_a_pitch_has_no_rates(name: str) -> None:
    """As docs/LINUXCNC.md says."""
    assert not hasattr(machine_of(name).module.library, "kinematicsJacobian")


def test_singular() -> None:
    """Where joints cannot follow there is no answer."""
    machine = machine_of("Kin_Scara4_ZCcoupled_Type1")
    axes = [10.0, 0.0, 5.0, 20.0]
    pose = machine.module.forward(axes)
    assert pose is not None and machine.module.jacobian(axes, pose) is None


def test_identity() -> None:
    """A joint has the rate of its letter, whatever the pose is."""
    machine = machine_of("Softkin_TableTable_AC")
    assert machine.module.library.kinematicsSwitch(1) == 0
    found = machine.module.jacobian([0.0] * 5, dict.fromkeys(LETTERS, 3.0))
    assert found is not None
    assert [[LETTERS[i] for i, v in enumerate(row) if v == 1.0] for row in found[:5]] == [[one] for one in "XYZAC"]
    assert sum(map(sum, found)) == 5.0
