"""Poses: from axis values to a pose, back again, and why a command is refused."""

import math
from functools import lru_cache

from derive.equations.chain_splits import is_spatial
from tests.catalogue.machines import Machine
from tests.text.comparisons.configurations import padded
from tests.text.controller import OK, Answer, asked, assert_same, is_close
from tests.text.pairs import Pair
from tests.text.reasons import compare_reason
from tests.text.samples import Command, Sample, commands

ROUNDING = 1e-11
ANSWERED = 3
"""The commands of a sample that have an answer, and are diagnosed."""
NEARLY_FREE = 1e-5
"""Where a margin is smaller an angle has lost digits: poses are compared, and angles by rounding over the margin."""


def forward(pair: Pair, sample: Sample) -> None:
    """AxesToCartesian writes the pose and the configuration that Python gives, or refuses with the same status."""
    status, answer = asked(pair.robot.forward, sample.axes)
    expected = (*answer[0], padded(answer[1])) if status == OK else None
    assert_same(pair.controller.forward(sample.axes), (status, expected), pair, sample)


def inverse(pair: Pair, sample: Sample) -> None:
    """CartesianToAxes gives the axis values of Python; where branches coincide, axis values of the same pose."""
    margin = _least_margin(pair, sample) if _is_spatial(pair) else 1.0
    for command, (status, answer) in solved(pair.machine, sample):
        frame = command.position, command.rotation
        expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
        found = pair.controller.inverse(*frame, command.configuration, command.reference)
        if margin < NEARLY_FREE and not is_close(found, (status, expected)):
            assert_same_pose(pair, found, (status, expected), command)
            assert margin == 0.0 or _are_near(pair, found, (status, expected), ROUNDING / margin)
        else:
            assert_same(found, (status, expected), pair, command)


def _least_margin(pair: Pair, sample: Sample) -> float:
    """The least singularity margin in size; 0 where branches coincide, 1 where the sample has no pose."""
    branches = own_bytes(pair, sample)
    if 3 in branches or not branches:
        return 0.0 if branches else 1.0
    return min(map(abs, pair.robot.singularity(sample.axes).margins.values()), default=1.0)


def _are_near(pair: Pair, found: Answer, expected: Answer, within: float) -> bool:
    """Whether axes differ by no more than so many radians and sizes of the machine."""
    units = [math.degrees(1.0) if j.is_angle else pair.machine.reach for j in pair.mechanism.joints]
    return all(abs(a - b) <= within * unit for a, b, unit in zip(found[1], expected[1], units, strict=False))


def _is_spatial(pair: Pair) -> bool:
    chain = pair.machine.mechanism.chain
    return chain is not None and is_spatial(chain)


@lru_cache(maxsize=1000)
def solved(machine: Machine, sample: Sample) -> tuple[tuple[Command, Answer], ...]:
    """The commands of a sample, each with the answer in Python: it is the same for all methods that are held against
    it.
    """
    return tuple(
        (c, asked(machine.robot.inverse, (c.position, c.rotation), c.configuration, c.reference))
        for c in commands(machine, sample)
    )


def own_bytes(pair: Pair, sample: Sample) -> tuple[int, ...]:
    """The branch bytes of a sample; nothing where it has no pose."""
    status, answer = asked(pair.robot.forward, sample.axes)
    return tuple(answer[1][: pair.robot.BRANCHES]) if status == OK else ()


def assert_same_pose(pair: Pair, found: Answer, expected: Answer, command: object) -> None:
    """Where branches meet the last digit decides half of those of an angle, and perhaps whether another is free.

    Both answers must reach the same pose, which is known to all digits.
    """
    assert found[0] == expected[0] == OK, f"{found} is not {expected}: {pair} {command}"
    count = len(pair.mechanism.joints)
    first, second = (pair.robot.forward(answer[1][:count])[0] for answer in (found, expected))
    apart = [abs(a - b) for a, b in zip(first.position, second.position, strict=True)]
    assert max(apart) < ROUNDING * pair.machine.reach, f"{found} is not {expected}: {pair} {command}"
    turned = [
        abs(a - b) for p, q in zip(first.rotation, second.rotation, strict=True) for a, b in zip(p, q, strict=True)
    ]
    assert max(turned) < ROUNDING or not pair.machine.closure.follows_rotation, (
        f"{found} is not {expected}: {pair} {command}"
    )


def diagnose(pair: Pair, sample: Sample) -> None:
    """Diagnose gives the reason of Python for every command of the sample that is refused, and no reason for the first
    that is not: what it finds then is what `inverse` compares for all of them.
    """
    answered = 0
    for command, (status, _) in solved(pair.machine, sample):
        answered += status == OK
        if status != OK or answered <= ANSWERED:
            compare_reason(pair, command, status)
