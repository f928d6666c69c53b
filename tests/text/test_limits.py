"""Limits that refuse, and small steps with the last answer as the reference, until one refuses."""

import numpy as np
import pytest

from tests.catalogue.machines import Array, Machine
from tests.catalogue.references import held_at
from tests.text.controller import OK, UNREACHABLE, Controller, asked, assert_same
from tests.text.limits import draw_inside, has_limits, is_inside
from tests.text.other_turns import check_other_turns
from tests.text.pairs import Pair
from tests.text.samples import Sample

WIDTH = 1.0
"""How far the limit on the other side is."""
BEYOND, TOLERATED = 1e-8, 1e-9
"""How far a pose is from a limit, relative to 1 and the value; the tolerance is 1e-9 of 1 and both limits."""


def random_one(pairs: tuple[Pair, ...]) -> Pair:
    """A machine with random dimensions, without limits."""
    return next(one for one in pairs if one.machine.label.startswith("random"))


@pytest.mark.slow("Excavator", "RodPalletizer", "CylinderPalletizer")
def test_every_limit_refuses_alone(pairs: tuple[Pair, ...]) -> None:
    one = random_one(pairs)
    words = {joint.key: f"{joint.name}: " for joint in one.mechanism.joints}
    for name in sorted(words.keys() | {quantity.name for quantity in one.mechanism.limited}):
        chosen = [(sample, value) for sample in one.regular if (value := limited_value(one, sample, name)) is not None]
        for sample, value in chosen[: 1 if one.mechanism.rods or one.mechanism.drives else 3]:
            beyond, tolerated = (share * (1.0 + abs(value)) for share in (BEYOND, TOLERATED))
            for lower, upper, expected in (
                (value - beyond, value + WIDTH, OK),
                (value - WIDTH, value + beyond, OK),
                (value + tolerated, value + WIDTH, OK),
                (value - WIDTH, value - tolerated, OK),
                (value + beyond, value + WIDTH, UNREACHABLE),
                (value - WIDTH, value - beyond, UNREACHABLE),
            ):
                limits = {f"lower_{name}": lower, f"upper_{name}": upper}
                found, reason, missing = answer(one, sample, limits)
                assert found == expected, f"{one} {sample} {limits}"
                assert found == OK or reason.startswith(words.get(name, "")) and beyond / 2 < missing <= beyond
                assert answer(one, sample, limits | {"check_limits": False})[0] == OK
        assert chosen, name


def test_a_turn_that_refuses_is_told_with_the_one_inside(pairs: tuple[Pair, ...]) -> None:
    one = random_one(pairs)
    for sample in one.regular[:3]:
        assert check_other_turns(one, sample) or not one.robot.PERIOD_AXES


def test_small_limits_are_limits(serial_pairs: tuple[Pair, ...]) -> None:
    one = serial_pairs[0]
    for index, joint in enumerate(one.mechanism.joints):
        for lower, upper in ((-0.2, 0.1), (0.0, 0.3), (-0.3, 0.0)):
            controller = Controller(one.library, one.mechanism)
            limits = {f"lower_{joint.key}": lower, f"upper_{joint.key}": upper}
            assert controller.initialise({**one.robot.parameters, **limits}) == OK
            assert controller.axis_properties(index)[1:] == (False, lower, upper)


def limited_value(one: Pair, sample: Sample, name: str) -> float | None:
    """The value at a pose of what has a limit; None where a limit may not stand there."""
    machine = one.machine
    for joint, value in zip(machine.mechanism.joints, sample.axes, strict=True):
        if joint.key == name:
            low, high = joint.limit_range or (-1e9, 1e9)
            return value if low + 2 * WIDTH <= value <= high - 2 * WIDTH else None
    quantities = machine.closure.limited(machine.closure.joints(np.array([sample.axes])))[0].tolist()
    return dict(zip((q.name for q in machine.mechanism.limited), quantities, strict=True))[name]


def answer(one: Pair, sample: Sample, limits: dict[str, float]) -> tuple[str, str, float]:
    """The status of inverse kinematics for the very configuration of a pose, with other limits, and why it refuses."""
    controller = Controller(one.library, one.mechanism)
    assert controller.initialise({**one.robot.parameters, **limits}) == OK
    position, rotation, data = controller.forward(sample.axes)[1]
    found: str = controller.inverse(position, rotation, data, sample.axes)[0]
    reason, missing = controller.diagnose(position, rotation, data, sample.axes)
    assert (missing > 0.0) == ("limit" in reason) == (found == UNREACHABLE)
    return found, reason, missing


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
def test_a_path_is_followed_without_a_jump(serial_pairs: tuple[Pair, ...]) -> None:
    lengths = []
    for one in serial_pairs:
        line = path(one.machine)
        allowed = is_inside(one.machine, line) | (not one.robot.checks_limits)
        lengths.append(follow(one, line, allowed))
    assert max(lengths) > 60, "no path is long"


def follow(one: Pair, line: Array, allowed: Array) -> int:
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
