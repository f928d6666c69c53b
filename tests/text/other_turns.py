"""A named turn that limits refuse while another is inside: both languages say which, and answer when it is named."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from derive.description.mechanism import Joint
from tests.catalogue.turns.axes import number_of
from tests.mechanisms import limit_names
from tests.text.controller import OK, Controller
from tests.text.samples import Sample

AROUND = 5.0
"""Degrees that a limit is from the value inside."""
TURNS = (-3, -2, -1, 1, 2, 3)


def check_other_turns(one: Any, sample: Sample) -> int:
    """For every axis of a machine that turns, and for all turns; the number of those that were
    named.
    """
    tried = 0
    for joint in one.mechanism.period_joints:
        value = sample.axes[one.mechanism.joints.index(joint)]
        for turns in TURNS:
            inside = value + 360.0 * turns
            if _allows(joint, inside):
                reason = f"{joint.name}: this turn is beyond a limit, name one inside [deg]"
                _check(one, sample, _around(joint.key, inside), joint, turns, reason)
                tried += 1
    for key, meaning, value, turning in _quantities(one, sample):
        for turns in (-1, 1):
            limits = _around(key, value + 360.0 * turns)
            for joint, slope in turning:
                reason = f"{meaning}: this turn of {joint.name} is beyond a limit, name one inside [deg]"
                _check(one, sample, limits, joint, turns * slope, reason)
                limits |= _around(joint.key, sample.axes[one.mechanism.joints.index(joint)])
            end = "below its lower" if turns > 0 else "above its upper"
            _check(one, sample, limits, None, 0, f"{meaning}: {end} limit [deg]")
            tried += 1
    return tried


def _check(one: Any, sample: Sample, limits: dict[str, float], joint: Joint | None, turns: int, expected: str) -> None:
    """With these limits the turn refuses, or what has no other turn; the turn inside is answered."""
    free = dict.fromkeys(limit_names(one.mechanism), 0.0)
    robot = type(one.robot)(**{**one.robot.parameters, **free, **limits})
    controller = Controller(one.library, one.mechanism)
    assert controller.initialise(robot.parameters) == OK
    frame, data = robot.forward(sample.axes)
    status, reason, missing, turn, _ = robot.diagnose(frame, data, sample.axes)
    assert controller.explain(*frame, data, sample.axes) == (reason, pytest.approx(missing, rel=1e-9), turn, 0.0)
    assert reason == expected
    assert missing == pytest.approx(360.0 * abs(turns) - AROUND if joint else 360.0 - AROUND, abs=1e-4)
    if joint is None:
        assert turn == 0
        return
    assert turn == number_of(sample.axes[one.mechanism.joints.index(joint)] + 360.0 * turns)
    place = robot.BRANCHES + one.mechanism.period_joints.index(joint)
    named = (*data[:place], turn, *data[place + 1 :])
    found = robot.inverse(frame, named, sample.axes)
    answer = controller.inverse(*frame, named, sample.axes)
    assert answer[0] == OK
    assert np.abs(np.subtract(answer[1][: len(found)], found)).max() < 1e-8


def _quantities(one: Any, sample: Sample) -> Iterator[tuple[str, str, float, list[tuple[Joint, int]]]]:
    """Angles with limits of their own: what they are called, their values, and the axes that turn them, the last one
    first.
    """
    limited = [q for q in one.mechanism.limited if q.is_angle]
    if not limited:
        return
    closure = one.machine.closure
    values = closure.limited(closure.joints(np.array([sample.axes])))[0].tolist()
    for quantity, value in zip(one.mechanism.limited, values, strict=True):
        slopes = ((j, int(quantity.value.coeff(j.symbol))) for j in reversed(one.mechanism.joints))
        yield quantity.name, quantity.meaning, value, [(j, slope) for j, slope in slopes if slope]


def _around(key: str, value: float) -> dict[str, float]:
    return {f"lower_{key}": value - AROUND, f"upper_{key}": value + AROUND}


def _allows(joint: Joint, value: float) -> bool:
    low, high = joint.limit_range or (-1e9, 1e9)
    return low <= value - AROUND and value + AROUND <= high
