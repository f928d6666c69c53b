"""Forward kinematics is the closure: for every machine, scalar and batch."""

import numpy as np
import pytest
import softkin

from derive.description.mechanism import Mechanism
from tests.catalogue.closure import ONE_DEGREE, Array
from tests.catalogue.hand_written import FORMULAS
from tests.catalogue.machines import MECHANISMS, Machine, machines_of
from tests.catalogue.refusals import refusal

ROUNDING = 1e-13
"""Of the closure, per size of the machine: axis values of a thousand degrees cost some digits."""


def test_forward_satisfies_the_closure(machines: tuple[Machine, ...]) -> None:
    for machine in machines:
        axes = machine.draw(1000, np.random.default_rng(1))
        positions, rotations, _, statuses = machine.robot.forward_batch(axes)
        assert (statuses == softkin.Status.OK).all()
        assert machine.error(axes, positions, rotations).max() < ROUNDING


def test_the_frame_is_plain_tuples(machines: tuple[Machine, ...]) -> None:
    axes = machines[0].draw(1, np.random.default_rng(3))[0]
    frame, configuration = machines[0].robot.forward(axes)
    assert isinstance(frame, softkin.Frame)
    assert [type(part) for part in (frame.position, frame.rotation, configuration)] == [tuple, tuple, tuple]
    assert {type(v) for v in frame.position} == {float}
    assert {type(v) for row in frame.rotation for v in row} == {float}
    assert {type(byte) for byte in configuration} <= {int}


def test_every_mechanism_has_a_formula_of_its_own() -> None:
    assert set(FORMULAS) == {m.name for m in MECHANISMS}


@pytest.mark.parametrize("name", FORMULAS)
def test_forward_is_what_the_literature_prints(name: str) -> None:
    (mechanism,) = (m for m in MECHANISMS if m.name == name)
    for machine in machines_of(mechanism):
        axes = machine.draw(300, np.random.default_rng(4))
        units = [ONE_DEGREE if j.in_degrees else 1.0 for j in mechanism.joints]
        offsets = [machine.robot.parameters[f"offset_{j.key}"] for j in mechanism.joints]
        *position, turn = FORMULAS[name](machine.robot.parameters, ((axes - offsets) * units).T)
        positions, rotations, _, _ = machine.robot.forward_batch(axes)
        assert np.abs(positions - np.stack(position, axis=1)).max() < 1e-13 * (machine.reach + np.abs(axes).max())
        expected = np.array(turn if isinstance(turn, tuple) else _about_z(turn, machine))
        assert np.abs(rotations - np.moveaxis(expected, 2, 0)).max() < ROUNDING


def _about_z(turn: Array, machine: Machine) -> list[list[Array]]:
    down = -1.0 if machine.robot.parameters.get("flange_down") else 1.0
    c, s, o = np.cos(turn), np.sin(turn), 0 * turn
    return [[c, -s * down, o], [s, c * down, o], [o, o, o + down]]


def test_what_the_machine_does_not_have_is_no_pose(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """A negative radius, a polar angle beyond the vertical: just outside, far outside, and a whole turn further."""
    for machine in machines:
        axes = machine.draw(20, np.random.default_rng(5))
        for i, joint in enumerate(mechanism.joints):
            if joint.domain is None:
                continue
            low, high = joint.domain
            ends = (-1e-6, -1.0, -90.0, -180.0, -270.0, -360.0)
            outside = [low + e for e in ends] + [high - e for e in ends if high < 1e9]
            for value in outside:
                there = axes.copy()
                there[:, i] = value + machine.closure.offsets[i]
                _, _, _, statuses = machine.robot.forward_batch(there)
                assert (statuses == softkin.Status.IMPOSSIBLE).all(), f"{joint.name} = {value}"
                assert refusal(machine.robot.forward, there[0]) is softkin.Status.IMPOSSIBLE
