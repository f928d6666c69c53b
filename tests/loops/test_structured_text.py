"""Closed loops in Structured Text, executed as text: every answer and every refusal is Python's."""

from __future__ import annotations

import numpy as np
import softkin
from softkin import KinematicsError

from tests.execution.controller import NOT_INITIALIZED, OK, Controller
from tests.execution.units import compiled
from tests.loops.machines import Machine

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def controller(machine: Machine) -> Controller:
    block = Controller(compiled(machine.mechanism), machine.mechanism)
    assert block.forward(machine.axes[0])[0] == NOT_INITIALIZED
    assert block.initialise(machine.given) == OK
    return block


def test_forward_and_inverse(machine: Machine) -> None:
    block = controller(machine)
    width = len(machine.mechanism.joints)
    for axes in machine.axes[:30]:
        frame, configuration = machine.robot.forward(tuple(axes))
        status, answer = block.forward(axes)
        assert status == OK
        np.testing.assert_allclose(answer[0], frame.position, rtol=1e-11, atol=1e-8)
        stored = tuple(b % 256 for b in configuration)
        assert answer[2][: len(stored)] == stored
        for slot in machine.robot.inverse_all(frame, reference=tuple(axes)):
            status, found = block.inverse(frame.position, IDENTITY, slot.configuration, axes)
            assert status == slot.status.softmotion
            if slot.axes is not None:
                np.testing.assert_allclose(found[:width], slot.axes, atol=1e-8)
                assert not any(found[width:])
        automatic = tuple(0 for _ in configuration)
        expected = machine.robot.inverse(frame, automatic, tuple(axes))
        np.testing.assert_allclose(block.inverse(frame.position, IDENTITY, automatic, axes)[1][:width], expected, atol=1e-8)


def test_jacobian_singularity_orientation(machine: Machine) -> None:
    block = controller(machine)
    for axes in machine.axes[:15]:
        derived = np.array(machine.robot.jacobian(tuple(axes)))
        status, found = block.jacobian(axes)
        assert status == OK
        rows, columns = derived.shape
        np.testing.assert_allclose(np.array(found)[:rows, :columns], derived, rtol=1e-10, atol=1e-8)
        assert np.count_nonzero(np.array(found)) <= rows * columns
        assert block.is_singular(axes) == machine.robot.singularity(tuple(axes)).is_singular
        assert block.orientation(axes) == (OK, IDENTITY)


def test_a_point_off_the_flange(machine: Machine) -> None:
    block = controller(machine)
    offset = (3.0, -2.0, 1.0 if len(machine.mechanism.task.position) == 3 else 0.0)
    width = len(machine.mechanism.joints)
    for axes in machine.axes[:15]:
        frame, _ = machine.robot.forward(tuple(axes))
        point = tuple(p + o for p, o in zip(frame.position, offset, strict=True))
        configuration = machine.robot.configuration_offset(tuple(axes), offset)
        if configuration:
            assert block.configuration_offset(axes, offset)[: len(configuration)] == tuple(b % 256 for b in configuration)
        status, found = block.inverse_offset(point, offset, configuration, axes)
        assert status == OK
        np.testing.assert_allclose(found[:width], axes, atol=1e-6)


def test_garbage_is_refused_as_in_python(machine: Machine) -> None:
    block = controller(machine)
    configuration = machine.robot.DEFAULT_CONFIGURATION
    zeros = tuple(0.0 for _ in machine.mechanism.joints)
    positions = [(v, w, 0.0) for v in (np.nan, np.inf, -np.inf, 1e300, 1e5, 0.0) for w in (np.nan, 0.0)]
    for position in positions:
        try:
            machine.robot.inverse((position, IDENTITY), configuration, zeros)
            expected = softkin.Status.OK
        except KinematicsError as error:
            expected = error.status
        assert block.inverse(position, IDENTITY, configuration, zeros)[0] == expected.softmotion
    for value in (np.nan, np.inf, 1e300, 1e8, 0.0):
        axes = (value, *zeros[1:])
        try:
            machine.robot.forward(axes)
            expected = softkin.Status.OK
        except KinematicsError as error:
            expected = error.status
        assert block.forward(axes)[0] == expected.softmotion
