"""Every module answers as the Python package does: poses, flags, joints, refusals, at regular and singular poses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import softkin

from derive.emit.linuxcnc.words import Orientation
from tests.linuxcnc.machine import NAMES, Machine, answered, differs, heading, machine_of, recorded
from tests.linuxcnc.module import LETTERS, Pose
from tests.orthonormal import about

pytestmark = pytest.mark.broad

SAME = 1e-12
SINGULAR = 1e-3
FREE = 1e-9
"""Near a singularity joints have fewer digits than the pose, which they reach to this part of the machine."""


@pytest.mark.parametrize("name", NAMES)
def test_forward(name: str) -> None:
    """Letters mean what the frame is, flags are the bytes of branches, and what has no pose is refused."""
    machine = machine_of(name)
    count = 0
    with_pose = {tuple(axes) for axes, _, _ in answered(machine)}
    for axes in recorded(name):
        if tuple(axes) not in with_pose:
            assert machine.module.forward(axes) is None
            count += 1
    assert count
    regular = 0
    for axes, frame, configuration in answered(machine):
        pose = machine.module.forward(axes)
        assert pose is not None
        _assert_means(machine, axes, pose, frame)
        branches = configuration[: len(machine.robot.CONFIGURATION) - len(machine.robot.PERIOD_AXES)]
        assert machine.module.flags == sum(byte << 2 * i for i, byte in enumerate(branches))
        regular += 1
    assert regular >= 10


def _assert_means(machine: Machine, axes: list[float], pose: Pose, frame: softkin.Frame) -> None:
    exact = SAME * machine.size
    position = dict(zip("XYZ", frame.position, strict=True))
    for letter in LETTERS:
        if letter in machine.words.position:
            assert pose[letter] == pytest.approx(position[letter], abs=exact)
        elif letter not in machine.words.letters:
            assert pose[letter] == 0.0
    for joint, letter in enumerate(machine.words.own):
        if letter:
            assert pose[letter] == axes[joint]
    if machine.words.orientation is Orientation.ANGLES:
        turned = about(2, pose["C"]) @ about(1, pose["B"]) @ about(0, pose["A"])
        assert np.allclose(turned, frame.rotation, atol=1e-12)
    elif machine.words.orientation in (Orientation.COUNTED, Orientation.NEAREST):
        apart = (pose["C"] - heading(frame.rotation) + 180.0) % 360.0 - 180.0
        assert apart == pytest.approx(0.0, abs=1e-10)


@pytest.mark.parametrize("name", NAMES)
def test_inverse(name: str) -> None:
    """On the branch of the flags, near the joints: the axes of Python for the same frame, or refused as there."""
    machine = machine_of(name)
    found = singular = 0
    for axes, _, configuration in answered(machine):
        pose = machine.module.forward(axes)
        assert pose is not None
        joints = machine.module.inverse(pose, axes)
        expected = _inverse_of_python(machine, pose, axes, configuration)
        assert (joints is None) == (expected is None), (axes, joints, expected)
        if joints is None or expected is None:
            continue
        margins = machine.robot.singularity(axes).margins.values()
        least = min((abs(m) for m in margins), default=1.0)
        if least > SINGULAR:
            assert differs(joints, expected) < SAME * 1e3 / least**2, (axes, joints, expected)
            found += 1
        else:
            _assert_reached(machine, pose, joints)
            singular += 1
    assert found >= 3 and found + singular >= 10


def _inverse_of_python(machine: Machine, pose: Pose, axes: list[float], given: Any) -> list[float] | None:
    if machine.words.orientation is Orientation.AXES:
        return axes
    turns = len(machine.robot.PERIOD_AXES)
    branches = tuple(given)[: len(given) - turns]
    frame = machine.frame_of(pose, axes)
    try:
        return list(machine.robot.inverse(frame, (*branches, *(0,) * turns), axes))
    except softkin.KinematicsError:
        return None


def _assert_reached(machine: Machine, pose: Pose, joints: list[float]) -> None:
    again = machine.module.forward(joints, pose)
    assert again is not None
    one, other = (machine.frame_of(p, joints) for p in (pose, again))
    assert np.allclose(one.position, other.position, atol=FREE * machine.size)
    assert np.allclose(one.rotation, other.rotation, atol=FREE)
