"""Margins against the matrices of the closure, A x' + B q' = 0, differentiated numerically."""

import numpy as np
import pytest
from softkin import KinematicsError, Status

from tests.catalogue.closure import Array
from tests.catalogue.loop_machines import LoopMachine, facing, facings
from tests.mechanisms import has_struts

ROUNDING = 1e-10
HALVINGS = 70
LEG, PLATE, BOUND = range(3)
"""The boundaries at which a straight path may end."""


def matrices(machine: LoopMachine, axes: Array) -> tuple[Array, Array]:
    joints, positions = machine.closure.joints(axes), machine.closure.poses(axes)[0]
    return machine.closure.by_position(joints, positions), machine.closure.by_joints(joints, positions)


def margins(machine: LoopMachine, axes: Array) -> dict[str, Array]:
    """The margins of a machine at axis values, by their names."""
    found = [machine.robot.singularity(row).margins for row in axes]
    return {name: np.array([m[name] for m in found]) for name in machine.robot.MARGINS}


def is_constant(ratios: Array) -> bool:
    """Whether ratios differ by rounding alone."""
    return bool(np.ptp(ratios) < ROUNDING * np.abs(ratios).max())


@pytest.mark.long
def test_type_1_margins_are_those_of_b_and_type_2_of_a(machines: tuple[LoopMachine, ...]) -> None:
    """But for a factor made of parameters: leg by leg, where each has a joint of its own, and in sign."""
    for machine in machines:
        axes = machine.draw(40, np.random.default_rng(1))
        a, b = matrices(machine, axes)
        found = margins(machine, axes)
        assembly = machine.mechanism.assembly
        assert assembly is not None
        assert is_constant(np.linalg.det(a) / found[assembly.margin])
        legs = [name for name in found if name != assembly.margin]
        assert is_constant(np.linalg.det(b) / np.prod([found[name] for name in legs], axis=0))
        for k, branch in enumerate(machine.mechanism.branches):
            assert legs[k] == branch.margin
            assert is_constant(b[:, k, k] / found[branch.margin])


@pytest.mark.long
def test_a_way_out_ends_at_a_singularity_or_a_bound(machines: tuple[LoopMachine, ...]) -> None:
    """Straight on until the slot is refused: a leg is stretched, a ball joint at its end, or the plate lost."""
    rng = np.random.default_rng(4)
    reasons = []
    for machine in machines:
        for axes in machine.draw(4, rng):
            start = machine.closure.poses(axes[None])[0][0]
            direction = np.zeros(3)
            direction[machine.closure.task] = rng.normal(size=len(machine.closure.task))
            held = len(machine.mechanism.rods[0].plate) - 1  # along X a biglide never ends, along Z a quill
            if has_struts(machine.mechanism):
                direction[:held] = 0.0  # along the plane of the anchors no way ends
            direction *= 4 * machine.reach / abs(direction[held])
            if has_struts(machine.mechanism) and _answers(machine, (start + direction)[None], axes)[0]:
                direction = -direction  # away from the anchors it never ends
            end = start + _edge(machine, start, direction, axes) * direction
            code = machine.own(axes[None])[0].tolist()
            reached = np.array(machine.changed(min_type2_margin=0.0).inverse((end, facing(machine.robot)), code, axes))
            near = _distances(machine, reached, end) / _distances(machine, axes, start)
            reasons.append(int(near.argmin()))
            assert near.min() < 1e-4, (machine.mechanism.name, near)
    assert (PLATE if has_struts(machines[0].mechanism) else LEG) in reasons
    assert not machines[0].mechanism.bounds or BOUND in reasons


def _distances(machine: LoopMachine, axes: Array, position: Array) -> Array:
    """From what ends a way, by the closure: a leg that is stretched, a plate that is lost, a bound."""
    joints = machine.closure.joints(axes[None])
    legs = np.linalg.det(machine.closure.by_joints(joints, position[None]))[0]
    plate = np.linalg.det(machine.closure.by_position(joints, position[None]))[0]
    return np.abs([legs, plate, machine.closure.room(joints, position[None])[0]])


def _answers(machine: LoopMachine, positions: Array, axes: Array) -> Array:
    """Whether the slot of a pose answers at each of the positions."""
    robot, code = machine.changed(min_type2_margin=0.0), machine.own(axes[None])[0]
    answered: Array = robot.inverse_batch(positions, facings(robot, len(positions)), code, axes)[1] == Status.OK
    return answered


def _edge(machine: LoopMachine, start: Array, direction: Array, axes: Array) -> float:
    """The share of the way at which the slot of a pose stops answering."""
    robot = machine.changed(min_type2_margin=0.0)
    code = machine.own(axes[None])[0]
    shares = np.linspace(0.0, 1.0, 4001)
    answers = _answers(machine, start + shares[:, None] * direction, axes)
    first = int(answers.argmin())
    assert answers[0] and not answers[first]
    low, high = float(shares[first - 1]), float(shares[first])
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        try:
            robot.inverse((start + middle * direction, facing(robot)), code.tolist(), axes)
        except KinematicsError as refused:
            assert refused.status is Status.UNREACHABLE
            high = middle
        else:
            low = middle
    return low
