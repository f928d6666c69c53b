"""Small steps, each with the last answer as the reference: no jump, until a limit refuses."""

import numpy as np
import pytest

from tests.catalogue.machines import Array, Machine
from tests.catalogue.references import held_at
from tests.text.controller import OK, UNREACHABLE, asked, assert_same
from tests.text.limits import draw_inside, has_limits, is_inside
from tests.text.serial_pairs import SerialPair

STEPS = 120
CANDIDATES = 40
CLOSE = 1e-8
"""To the axis values of the path, away from singular poses: relative to a turn, or to the size of the machine."""


def path(machine: Machine) -> Array:
    """The longest of some straight lines between axis values, as far as it meets no singular pose; over turns."""
    rng = np.random.default_rng(5)
    starts = (draw_inside if has_limits(machine) else Machine.draw)(machine, CANDIDATES, rng)
    shares = np.linspace(0.0, 1.0, STEPS)[:, None]
    found = starts[:1]
    for start in starts:
        way = np.where(machine.closure.angles, 400.0, 0.2 * machine.reach) * rng.uniform(-1.0, 1.0, len(start))
        line = start + shares * way
        usable = machine.is_regular(line) & inside_domains(machine, line)
        length = STEPS if usable.all() else int(np.argmin(usable))
        found = max(found, line[:length], key=len)
    return found


def inside_domains(machine: Machine, axes: Array) -> Array:
    """Whether joints are where the closure allows them, and where a climbing axis may turn to."""
    usable = np.ones(len(axes), dtype=bool)
    joints = axes - machine.closure.offsets
    for index, joint in enumerate(machine.mechanism.joints):
        if joint.domain is not None:
            usable &= (joints[:, index] >= joint.domain[0]) & (joints[:, index] <= joint.domain[1])
        elif joint.pitch != 0:
            usable &= np.abs(axes[:, index]) <= 720.0
    return usable


@pytest.mark.broad
@pytest.mark.long
def test_a_path_is_followed_without_a_jump(serial_pairs: tuple[SerialPair, ...]) -> None:
    """The block follows a path without a jump of an axis."""
    lengths = []
    for one in serial_pairs:
        line = path(one.machine)
        allowed = is_inside(one.machine, line) | (not one.robot.checks_limits)
        lengths.append(follow(one, line, allowed))
    assert max(lengths) > 60, "no path is long"


def follow(one: SerialPair, line: Array, allowed: Array) -> int:
    """Walk along a line in Cartesian space; the number of steps that were answered."""
    _, (_, _, data) = one.controller.forward(line[0])
    branches = one.robot.BRANCHES
    configuration = data[:branches] + (0,) * len(one.robot.PERIOD_AXES)  # the branch is kept, turns follow
    last = tuple(line[0].tolist())
    tolerance = CLOSE * (one.machine.reach + 360.0)
    for step, (axes, is_allowed) in enumerate(zip(line, allowed, strict=True)):
        position, rotation, _ = one.controller.forward(axes.tolist())[1]
        last = tuple(held_at(one.robot, axes, last).tolist())
        found = one.controller.inverse(position, rotation, configuration, last)
        status, answer = asked(one.robot.inverse, (position, rotation), configuration, last)
        assert_same((found[0], found[1] and found[1][: len(axes)]), (status, answer), one, axes, last)
        assert found[0] == (OK if is_allowed else UNREACHABLE), f"{one} {axes}"
        if status != OK:
            return step
        last = answer
        assert np.abs(np.array(last) - axes).max() <= tolerance, f"{one} jumps to {last} at {axes}"
    return len(line)
