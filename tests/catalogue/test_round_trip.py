"""Inverse of forward, and forward of inverse: on every branch, over several turns; every root has a slot."""

from itertools import product

import numpy as np
import pytest
from softkin import Status

from tests.catalogue.closure import Array
from tests.catalogue.machines import Machine, few
from tests.catalogue.references import held_at
from tests.catalogue.roots import SAME, distance, principal, solutions
from tests.mechanisms import has_struts, in_the_task
from tests.orthonormal import rodrigues

POSES = 300
AXES = 1e-9
"""Degrees or lengths: how well axis values are found again at a regular pose."""
FRAME = 1e-12


def slots(machine: Machine) -> list[tuple[int, ...]]:
    """The branch bytes of every slot, the first byte fastest."""
    return [bytes_[::-1] for bytes_ in product((1, 2), repeat=machine.robot.BRANCHES)]


def strangers(machine: Machine, axes: Array) -> Array:
    """References that have nothing to do with the axes, but for what is held."""
    return held_at(machine.robot, axes, np.random.default_rng(99).uniform(-900, 900, axes.shape))


def test_the_configuration_selects_the_same_axes(machines: tuple[Machine, ...]) -> None:
    """With every branch and period named, whatever the reference is."""
    for machine in few(machines):
        axes = machine.draw(POSES, np.random.default_rng(1))
        frames = machine.closure.poses(axes)
        _, _, configurations, _ = machine.robot.forward_batch(axes)
        found, statuses = machine.robot.inverse_batch(*frames, configurations, strangers(machine, axes))
        assert (statuses == Status.OK).all()
        assert np.abs(found - axes).max() < AXES


def test_every_slot_satisfies_the_closure(machines: tuple[Machine, ...]) -> None:
    for machine in few(machines):
        axes = machine.draw(POSES, np.random.default_rng(4))
        frames = machine.closure.poses(axes)
        answers, near = np.zeros(len(axes), dtype=int), held_at(machine.robot, axes, axes * 0.01)
        for slot in slots(machine):
            configuration = slot + (0,) * len(machine.robot.PERIOD_AXES)
            found, statuses = machine.robot.inverse_batch(*frames, configuration, near)
            answered = machine.answers(statuses)
            answers += answered
            found = found[answered]
            assert machine.miss(found, *(f[answered] for f in frames)).max(initial=0.0) < FRAME
            positions, _, written, _ = machine.robot.forward_batch(found)
            back = machine.leads_back(found)
            apart = in_the_task(machine.mechanism.name, positions - frames[0][answered])
            assert np.abs(apart)[back].max(initial=0.0) < AXES * machine.reach
            assert (written[back, : len(slot)] == slot).all()
        assert (answers >= 1).all()
        assert answers.max() == 2**machine.robot.BRANCHES or machine.mechanism.rods or machine.mechanism.drives


def test_inverse_all_holds_every_branch_in_its_slot(machines: tuple[Machine, ...]) -> None:
    for machine in few(machines):
        robot = machine.changed(check_limits=False)  # near the end of an axis the other branch may be beyond it
        axes = machine.draw(10, np.random.default_rng(5))
        for values, position, rotation in zip(axes, *machine.closure.poses(axes), strict=True):
            found = robot.inverse_all((position, rotation), values)
            assert [s.configuration[: robot.BRANCHES] for s in found] == slots(machine)
            are_good = machine.answers(np.array([s.status for s in found]))
            answered = [s for s, good in zip(found, are_good, strict=True) if good]
            for solution in answered:
                assert solution.axes is not None
                again = robot.inverse((position, rotation), solution.configuration, strangers(machine, values))
                assert np.abs(np.subtract(again, solution.axes)).max() < AXES
            assert min(np.abs(np.subtract(s.axes, values)).max() for s in answered) < AXES


def compare(machine: Machine, position: Array, rotation: Array, axes: Array) -> int:
    """Hold the slots of a pose against the roots of the closure, with held axes where they are; how many there are."""
    roots = solutions(machine, position, rotation, machine.closure.joints(axes[None])[0])
    robot = machine.open_robot
    found = robot.inverse_all((position, rotation), held_at(robot, axes))
    slots = [s.axes for s in found if s.status is Status.OK]
    assert len(slots) == len(roots)
    assert all(s.status in (Status.OK, Status.UNREACHABLE) for s in found)
    if roots:
        joints = principal(machine, machine.closure.joints(np.array(slots)), position, rotation)
        for root in roots:
            assert min(np.abs(distance(machine, root, other)).max() for other in joints) < SAME
    return len(roots)


@pytest.mark.long("Pos_RRR", "Scara4")
def test_the_slots_are_the_roots_of_the_closure(machines: tuple[Machine, ...]) -> None:
    """The slots hold exactly the roots of the closure that root finding from many starts finds."""
    counts = set()
    for machine in few(machines):
        # Of two that are drawn: where one alone is, 120 starts find 7 roots of an articulated arm, and 480 all 8
        axes = machine.draw(2, np.random.default_rng(31))[:1]
        for values, position, rotation in zip(axes, *machine.closure.poses(axes), strict=True):
            counts.add(compare(machine, position, rotation, values))
    most = 2 ** machines[0].robot.BRANCHES
    assert min(counts) >= 1
    assert max(counts) == most or machines[0].mechanism.rods or machines[0].mechanism.drives
    assert counts == {most} or not machines[0].branches_meet_together


@pytest.mark.slow("Hexaglide", "ThreeParallel")
@pytest.mark.long("Pos_RRR")
def test_where_the_closure_has_no_root_no_slot_answers(machines: tuple[Machine, ...]) -> None:
    """From the middle to twice the reach, or turns: two branches of a serial machine answer together, or none."""
    counts = set()
    for machine in machines[::2]:
        axes = machine.draw(3, np.random.default_rng(32))
        scales = (0.05, 0.6, 2.2)
        for values, position, rotation, scale in zip(axes, *machine.closure.poses(axes), scales, strict=True):
            aside = [0.0, 2.0, 0.0] if machine.mechanism.is_platform else [2.0, 0.0, 0.0]
            beyond = np.multiply(aside, machine.reach * (scale > 1.0))
            turned = rotation if machine.mechanism.task.position else rotation @ rodrigues((1.0, 0.0, 0.0), scale)
            counts.add(compare(machine, scale * position + beyond, turned, values))
    most = 2 ** machines[0].robot.BRANCHES
    if machines[0].branches_meet_together:
        assert counts == ({0, most} if machines[0].has_a_reach else {most})
    else:
        assert 0 in counts or has_struts(machines[0].mechanism)
        assert counts <= set(range(0, most + 1, 1 if machines[0].mechanism.rods or machines[0].mechanism.drives else 2))
