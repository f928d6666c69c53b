"""Loops whose plate carries a joint that turns the tool: counted, both ways, in both languages, where they end."""

from dataclasses import replace
from functools import cache
from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose
from softkin import Status

from derive.description.mechanism import DescriptionError, Mechanism, Task, Turning, X, Y
from derive.description.validate import validate
from derive.frames import Rz
from derive.kinematics.build import build
from tests.catalogue.loop_machines import LoopClosure
from tests.machines.carried import A1, A2, CARRIED, TIP, C, five_bar
from tests.machines.grid import grid, is_own
from tests.machines.made import Array, Made, made
from tests.text.controller import OK

pytestmark = pytest.mark.slow

EVERY = pytest.mark.parametrize("name", CARRIED)
FEW = 8
_CLOSED, _SAME = 1e-9, 1e-7


def closure_of(machine: Made) -> LoopClosure:
    assert isinstance(machine.closure, LoopClosure)
    return machine.closure


@cache
def regular(name: str) -> Array:
    """Axis values at which the loop closes, as the closure says, away from singular poses."""
    axes = grid(made(name))
    return axes[is_own(made(name), axes)]


def counted(machine: Made, axes: Array) -> int:
    """Solutions at a pose: combinations of roots of the equation of every leg that are in the mode of the machine."""
    closure, (joints,) = closure_of(machine), machine.closure.joints(axes[None])
    positions, rotations = closure.poses(axes[None])
    roots = []
    for leg, branch in enumerate(machine.mechanism.rods):
        ends = np.pi if closure.angles[leg] else 4.0 * machine.reach
        tried = np.tile(joints, (4001, 1))
        tried[:, leg] = np.linspace(-ends, ends, len(tried))
        many = [np.tile(a, (len(tried), *[1] * (a.ndim - 1))) for a in (positions, rotations)]
        value = closure.equations(tried, *many)[:, leg]
        found = np.flatnonzero(value[:-1] * value[1:] < 0)
        assert len(found) == 2, branch.name
        share = value[found] / (value[found] - value[found + 1])
        roots.append(tried[found, leg] + share * (tried[found + 1, leg] - tried[found, leg]))
    every = np.tile(joints, (2 ** len(roots), 1))
    every[:, : len(roots)] = list(product(*roots))
    return int((closure.side(every, np.tile(positions, (len(every), 1))) > 0).sum())


@EVERY
def test_forward_is_where_the_loop_closes(name: str) -> None:
    """Newton's method on the closure from far away finds the same pose; where it finds none, forward refuses."""
    machine = made(name)
    axes = grid(machine)
    expected, turned = closure_of(machine).poses(axes)
    positions, rotations, _, statuses = machine.robot.forward_batch(axes)
    closed = np.isfinite(expected).all(axis=1)
    assert (statuses == np.where(closed, Status.OK, Status.IMPOSSIBLE)).all()
    own = regular(name)
    expected, turned = closure_of(machine).poses(own)
    positions, rotations, _, _ = machine.robot.forward_batch(own)
    assert_allclose(positions, expected, rtol=0.0, atol=1e-9 * machine.reach)
    assert_allclose(rotations, turned, rtol=0.0, atol=1e-12)


@EVERY
def test_the_slots_hold_what_the_equations_of_the_legs_have(name: str) -> None:
    machine = made(name)
    robot, axes = machine.robot.changed(min_type2_margin=0.0), regular(name)[:20]
    positions, rotations, _, _ = robot.forward_batch(axes)
    statuses = robot.inverse_all_batch(positions, rotations, axes)[1]
    assert [counted(machine, row) for row in axes] == (statuses == Status.OK).sum(axis=1).tolist()


@EVERY
def test_a_tilted_rotation_is_projected_to_its_heading(name: str) -> None:
    """The position is met exactly, and the heading of the commanded rotation; the tilt is left out."""
    machine, tilt = made(name), np.array([[1.0, 0.0, 0.0], [0.0, 0.8, -0.6], [0.0, 0.6, 0.8]])
    axes = regular(name)[:FEW]
    positions, rotations, configurations, _ = machine.robot.forward_batch(axes)
    swung = tilt @ rotations
    found, statuses = machine.robot.inverse_batch(positions, swung, configurations, axes)
    assert (statuses == Status.OK).all()
    assert_allclose(found, axes, rtol=0.0, atol=1e-7)


@EVERY
def test_the_jacobian_is_that_of_the_closure(name: str) -> None:
    machine = made(name)
    axes = regular(name)[:40]
    positions, _ = closure_of(machine).poses(axes)
    expected = machine.closure.jacobian(axes, positions)
    assert machine.robot.JACOBIAN_ROWS[-1] == "turn z"
    for row, own in zip(axes, expected, strict=True):
        found = np.array(machine.robot.jacobian(row))
        assert np.abs(found - own).max() <= 1e-9 * np.abs(own).max()


@pytest.mark.parametrize("name", [n for n, m in CARRIED.items() if m.offset_interface])
def test_a_point_off_the_flange_holds_the_tool(name: str) -> None:
    """The point leads back to the axes, in both languages: C stays, and the loop shifts the flange."""
    machine = made(name)
    controller = machine.controller()
    offset = np.array([0.04, -0.03, 0.0]) * machine.reach
    for axes in regular(name)[:FEW]:
        frame, _ = machine.robot.forward(axes)
        point = tuple(np.add(frame.position, np.array(frame.rotation) @ offset))
        configuration = machine.robot.configuration_offset(axes, tuple(offset))
        found = machine.robot.inverse_offset(point, tuple(offset), configuration, axes)
        assert_allclose(found, axes, rtol=0.0, atol=1e-7)
        status, same = controller.inverse_offset(point, tuple(offset), configuration, axes.tolist())
        assert status == OK and np.abs(np.subtract(same[: len(axes)], found)).max() <= _SAME
        turned = axes + np.where([j.symbol == C.symbol for j in machine.mechanism.joints], 0.3, 0.0)
        if "climbs" not in name:  # there the quill follows C
            code = (0,) * len(configuration)
            elsewhere = np.array(machine.robot.inverse_offset(point, tuple(offset), code, turned))
            there, _ = machine.robot.forward(elsewhere)
            reached = np.add(there.position, np.array(there.rotation) @ offset)
            assert_allclose(reached, point, rtol=0.0, atol=1e-9 * machine.reach)
            assert elsewhere[-1] == turned[-1]


@EVERY
def test_a_stretched_leg_is_an_answer_and_rods_in_line_are_none(name: str) -> None:
    """Toward a type 1 singularity the inverse answers up to the end; beyond it every slot refuses."""
    machine = made(name)
    robot, controller = machine.robot.changed(min_type2_margin=0.0), machine.controller()
    ends = 0
    for axes in regular(name)[:FEW]:
        frame, configuration = robot.forward(axes)
        low, high = 0.0, 4.0 * machine.reach
        for _ in range(60):
            middle = (low + high) / 2
            place = np.add(frame.position, (0.3 * middle, middle, 0.0))
            answered = robot.inverse_batch([place], [frame.rotation], configuration, axes)[1][0] == Status.OK
            low, high = (middle, high) if answered else (low, middle)
        assert controller.inverse((50.0 * machine.reach, 0.0, 0.0), frame.rotation, configuration, axes)[0] != OK
        last = np.add(frame.position, (0.3 * low, low, 0.0))
        found, statuses = robot.inverse_batch([last], [frame.rotation], configuration, axes)
        assert statuses[0] == Status.OK
        assert machine.error(found, np.array([last]), np.array([frame.rotation]))[0] <= _CLOSED
        assert robot.singularity(found[0]).is_singular
        ends += 1
    assert ends == min(FEW, len(regular(name)))


REFUSED = {
    "a heading of a chain": (
        lambda m: replace(m, rods=(), chain=Rz(A1), assembly=None, branches=(), joints=(A1, A2, C)),
        "a chain tells the heading of its flange itself",
    ),
    "a heading that is not commanded": (
        lambda m: replace(m, task=Task("xy"), joints=m.joints),
        "the task must command that, Turning.ABOUT_Z",
    ),
    "a heading by a gear": (lambda m: replace(m, heading=2 * C.symbol), "must be a sum of rotary joints"),
    "a home pose": (lambda m: replace(m, home=(0, 0, 0)), "needs no home pose"),
    "a tool that only a loop joint turns": (lambda m: replace(m, heading=A1.symbol), "joint 'C' occurs nowhere"),
    "a tool that nothing is said of": (
        lambda m: replace(m, heading=None),
        "joint 'C' occurs nowhere in the closure: where it turns the tool on the plate, say so by heading=C",
    ),
    "a second quill": (
        lambda m: replace(m, closure=(X - Y,)),
        "the closure has 4 equations, and the task commands only 3 quantities",
    ),
    "a point off a flange that an arm turns": (
        lambda m: replace(m, heading=C.symbol + A2.symbol),
        "with offset_interface=False it could be built, but for a point off the flange joint 'A2', which the position "
        "determines, turns the flange",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_is_not_described_as_needed_is_refused(what: str) -> None:
    """The sentence names the fault."""
    change, said = REFUSED[what]
    with pytest.raises(DescriptionError) as refused:
        build(validate(change(five_bar("Refused", TIP))))
    assert said in str(refused.value)


def test_the_five_bar_itself_is_sound() -> None:
    """The description that the refusals break is accepted, and one with a task of its plane alone too."""
    sound = five_bar("Sound", TIP)
    assert build(validate(sound)).rows == ("x", "y", "turn z")
    plain: Mechanism = replace(sound, heading=None, joints=sound.joints[:2], task=Task("xy", Turning.NONE))
    assert build(validate(plain)).rows == ("x", "y")
