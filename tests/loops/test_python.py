"""Closed loops in Python: forward, every slot of the inverse, Jacobian, margins, refusals."""

from __future__ import annotations

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from tests.loops.machines import LOOPS, Machine


def test_there_are_all_loops() -> None:
    assert len(LOOPS) == 10


def test_forward_closes_the_loop(machine: Machine) -> None:
    positions, rotations, _, statuses = machine.robot.forward_batch(machine.axes)
    assert (statuses == Status.OK).all()
    scale = float(np.max(np.abs(positions))) + 1.0
    assert np.max(np.abs(machine.residual(machine.axes, positions))) < 1e-11 * scale**2
    assert (rotations == np.eye(3)).all()


def test_scalar_and_batch_agree(machine: Machine) -> None:
    positions, _, configurations, _ = machine.robot.forward_batch(machine.axes)
    for axes, position, configuration in zip(machine.axes, positions, configurations, strict=True):
        frame, reported = machine.robot.forward(tuple(axes))
        np.testing.assert_allclose(frame.position, position, rtol=1e-12, atol=1e-9)
        assert tuple(configuration) == reported


def test_every_slot_closes_the_loop_and_one_is_the_way_back(machine: Machine) -> None:
    total = 0
    for axes in machine.axes[:40]:
        frame, configuration = machine.robot.forward(tuple(axes))
        slots = machine.robot.inverse_all(frame, reference=tuple(axes))
        assert len(slots) == 2 ** len(machine.mechanism.branches)
        good = [s for s in slots if s.status is Status.OK]
        assert good
        total += len(good)
        found = np.array([s.axes for s in good])
        scale = float(np.max(np.abs(frame.position))) + 1.0
        residual = machine.residual(found, np.repeat([frame.position], len(good), axis=0))
        assert np.max(np.abs(residual)) < 1e-10 * scale**2
        for slot in good:  # the other assembly mode is refused: forward finds the same pose
            again, _ = machine.robot.forward(slot.axes)
            np.testing.assert_allclose(again.position, frame.position, atol=1e-7 * scale)
        back = machine.robot.inverse(frame, configuration, tuple(axes))
        np.testing.assert_allclose(back, axes, atol=1e-7)
    assert total >= 40


def test_jacobian_against_differences(machine: Machine) -> None:
    step = 1e-5
    for axes in machine.axes[:20]:
        derived = np.array(machine.robot.jacobian(tuple(axes)))
        for column, joint in enumerate(machine.mechanism.joints):
            shift = np.zeros(len(axes))
            shift[column] = step
            ahead, behind = (np.array(machine.robot.forward(tuple(axes + s))[0].position) for s in (shift, -shift))
            unit = np.pi / 180 if joint.is_angle else 1.0
            expected = (ahead - behind)[: len(derived)] / (2 * step * unit)
            np.testing.assert_allclose(derived[:, column], expected, rtol=1e-4, atol=1e-3 * np.max(np.abs(derived)))


def test_margins_multiply_to_the_determinant(machine: Machine) -> None:
    ratios = []
    for axes in machine.axes[:30]:
        margins = machine.robot.singularity(tuple(axes)).margins
        type_2 = machine.mechanism.assembly.margin
        product = np.prod([abs(v) for n, v in margins.items() if n != type_2]) / abs(margins[type_2])
        ratios.append(abs(np.linalg.det(np.array(machine.robot.jacobian(tuple(axes))))) / product)
    np.testing.assert_allclose(ratios, ratios[0], rtol=1e-8)


def test_near_a_type_2_singularity_the_inverse_refuses(machine: Machine) -> None:
    margin = machine.mechanism.assembly.margin
    sizes = [abs(machine.robot.singularity(tuple(a)).margins[margin]) for a in machine.axes]
    least = float(np.median(sizes)) + 1e-6
    careful = machine.robot.__class__(**{**machine.given, "min_type2_margin": least})
    refused = 0
    for axes in machine.axes:
        frame, configuration = machine.robot.forward(tuple(axes))
        near = abs(machine.robot.singularity(tuple(axes)).margins[margin]) < least
        try:
            careful.inverse(frame, configuration, tuple(axes))
            assert not near
        except KinematicsError as error:
            assert near
            assert error.status is Status.UNREACHABLE
            refused += 1
    assert refused


def test_far_away_and_garbage(machine: Machine) -> None:
    identity = np.eye(3)
    with pytest.raises(KinematicsError) as far:
        machine.robot.inverse(((1e5, 1e5, 0.0), identity))
    assert far.value.status is Status.UNREACHABLE
    for wrong in (np.nan, np.inf, 1e300):
        with pytest.raises(KinematicsError) as bad:
            machine.robot.inverse(((wrong, 0.0, 0.0), identity))
        assert bad.value.status is Status.BAD_INPUT
        with pytest.raises(KinematicsError) as bad:
            machine.robot.forward((wrong, *machine.axes[0][1:]))
        assert bad.value.status is Status.BAD_INPUT
        assert machine.robot.singularity((wrong, *machine.axes[0][1:])).is_singular


def test_dimensions_that_form_no_machine() -> None:
    with pytest.raises(KinematicsError, match="stewart"):
        softkin.TripodRotary(
            arm_length_1=200.0, arm_length_2=450.0, arm_1_radius=140.0, stewart_radius=10.0, distance=40.0,
            max_angle_ball_joint=45.0,
        )
    with pytest.raises(KinematicsError, match="line"):
        softkin.TripodP3Z(
            arm_length=269.0, rail_x_1=100.0, rail_x_2=200.0, rail_x_3=300.0, rail_y_1=0.0, rail_y_2=0.0, rail_y_3=0.0
        )
