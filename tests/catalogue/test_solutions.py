"""The slots hold all solutions: as many as a search over the whole joint space finds, and the same ones."""

import numpy as np
import pytest
from softkin import Status

from tests.catalogue.closure import Array
from tests.catalogue.machines import Machine, few
from tests.catalogue.references import held_at
from tests.catalogue.roots import SAME, distance, principal, solutions


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
    """Positions from the middle of the machine to twice its reach: two branches of a serial one answer together, or
    none.
    """
    counts = set()
    for machine in machines[::2]:
        axes = machine.draw(3, np.random.default_rng(32))
        scales = (0.05, 0.6, 2.2)
        for values, position, rotation, scale in zip(axes, *machine.closure.poses(axes), scales, strict=True):
            beyond = np.array([0.0, 2.0 * machine.reach, 0.0]) if machine.mechanism.is_platform and scale > 1.0 else 0.0
            counts.add(compare(machine, scale * position + beyond, rotation, values))
    most = 2 ** machines[0].robot.BRANCHES
    if machines[0].branches_meet_together:
        assert counts == ({0, most} if machines[0].has_a_reach else {most})
    else:
        assert 0 in counts
        assert counts <= set(
            range(0, most + 1, 2 if not (machines[0].mechanism.rods or machines[0].mechanism.drives) else 1)
        )
