"""All poses of a closed loop: those of both assembly modes, and no more by Newton's method on the closure."""

import numpy as np

from tests.catalogue.loop_machines import LoopMachine

ROWS = 5
DIRECTIONS = 30
"""The places, beyond everything, from which Newton's method starts."""


def test_they_are_all_that_the_closure_has(machines: tuple[LoopMachine, ...]) -> None:
    machine, rng = machines[-1], np.random.default_rng(8)
    axes = machine.draw(ROWS, rng)
    joints = machine.closure.joints(axes)
    directions = rng.normal(size=(DIRECTIONS, 3))
    directions /= np.linalg.norm(directions[:, machine.closure.task], axis=1)[:, None]
    ends = [machine.closure.assembly_from(joints, direction) for direction in directions]
    both = 0
    for k, row in enumerate(axes.tolist()):
        found = machine.robot.forward_all(row)
        positions = np.array([one.frame.position for one in found])
        here = np.tile(joints[k], (len(found), 1))
        assert (
            machine.error(np.tile(row, (len(found), 1)), positions, np.array([f.frame.rotation for f in found])).max()
            < 1e-12
        )
        assert ((machine.closure.side(here, positions) < 0.0) == [one.is_other for one in found]).all()
        assert found[0][:2] == machine.robot.forward(row) and len(found) <= 2
        for ends_there, closed in ends:
            end = ends_there[k]
            if closed[k] and machine.closure.room(joints[k : k + 1], end[None])[0] >= 0.0:
                assert np.linalg.norm(positions - end, axis=1).min() < 1e-9 * machine.reach
        both += len(found) == 2
    assert both
