"""Poses: from axis values to a pose, back again, and why a command is refused."""

from __future__ import annotations

from functools import lru_cache

from derive.equations.chain_splits import is_spatial
from tests.catalogue.machines import Machine
from tests.text.closeness import asked, assert_same, is_close
from tests.text.comparisons.configurations import padded
from tests.text.controller import OK, Answer
from tests.text.reasons import compare_reason
from tests.text.samples import Command, Sample, commands
from tests.text.serial_pairs import SerialPair

ROUNDING = 1e-11
ANSWERED = 3
"""The commands of a sample that have an answer, and are diagnosed."""
NEARLY_FREE = 1e-5
"""Where a margin is smaller, steps on the closure may end anywhere along what hardly moves the pose."""


def forward(pair: SerialPair, sample: Sample) -> None:
    """AxesToCartesian writes the pose and the configuration that Python gives, or refuses with the same status."""
    status, answer = asked(pair.robot.forward, sample.axes)
    expected = (*answer[0], padded(answer[1])) if status == OK else None
    assert_same(pair.controller.forward(sample.axes), (status, expected), pair, sample)


def inverse(pair: SerialPair, sample: Sample) -> None:
    """CartesianToAxes gives the axis values of Python; where branches coincide, axis values of the same pose."""
    coincide = _is_spatial(pair) and _loses_digits(pair, sample)
    for command, (status, answer) in solved(pair.machine, sample):
        frame = command.position, command.rotation
        expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
        found = pair.controller.inverse(*frame, command.configuration, command.reference)
        if coincide and not is_close(found, (status, expected)):
            assert_same_pose(pair, found, (status, expected), command)
        else:
            assert_same(found, (status, expected), pair, command)


def _loses_digits(pair: SerialPair, sample: Sample) -> bool:
    """Whether branches coincide, or so nearly that the last digit of a pose is one of the first of an angle."""
    bytes_of_branches = own_bytes(pair, sample)
    if not bytes_of_branches:
        return False
    margins = pair.robot.singularity(sample.axes).margins.values()
    return 3 in bytes_of_branches or any(abs(margin) < NEARLY_FREE for margin in margins)


def _is_spatial(pair: SerialPair) -> bool:
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


def own_bytes(pair: SerialPair, sample: Sample) -> tuple[int, ...]:
    """The branch bytes of a sample; nothing where it has no pose."""
    status, answer = asked(pair.robot.forward, sample.axes)
    return tuple(answer[1][: pair.robot.BRANCHES]) if status == OK else ()


def assert_same_pose(pair: SerialPair, found: Answer, expected: Answer, command: object) -> None:
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


def diagnose(pair: SerialPair, sample: Sample) -> None:
    """Diagnose gives the reason of Python for every command of the sample that is refused, and no reason for the first
    that is not: what it finds then is what `inverse` compares for all of them.
    """
    answered = 0
    for command, (status, _) in solved(pair.machine, sample):
        answered += status == OK
        if status != OK or answered <= ANSWERED:
            compare_reason(pair, command, status)
