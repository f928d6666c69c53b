"""Every reason of Diagnose, provoked: each number is made NaN in turn, and each condition violated in turn."""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

from tests.text.controller import OK, asked, assert_same
from tests.text.samples import HALF_TURN, Command, Sample

_SHEAR = 1e-4
"""Off the diagonal it is seen, on the diagonal its square is not."""


def provoke(one: Any, sample: Sample) -> None:
    """Both languages give the same reason for a machine at a pose, and for
    every command beside it.
    """
    for command in _commands(one, sample):
        compare_reason(one, command)


def compare_reason(one: Any, command: Command, inverse: str | None = None) -> None:
    """Word for word and number by number; there is a reason where the inverse refuses, and nowhere else. Its status is
    asked for where it is not given.
    """
    frame = command.position, command.rotation
    if inverse is None:
        inverse = asked(one.robot.inverse, frame, command.configuration, command.reference)[0]
    found = one.controller.explain(*frame, command.configuration, command.reference)
    status, reason, missing, turn, projection = one.robot.diagnose(frame, command.configuration, command.reference)
    assert status.softmotion == inverse
    assert_same(found, (reason, missing, turn, projection), one, command)
    assert (reason == "") == (status.softmotion == OK)
    assert (turn != 0) == (": this turn" in reason)
    assert missing >= 0.0 and projection * missing == 0.0


def _commands(one: Any, sample: Sample) -> Iterator[Command]:
    (position, rotation), own = one.robot.forward(sample.axes)
    near = sample.axes
    for k in range(3):
        yield Command(_changed(position, k), rotation, own, near)
    for k in range(9):
        flat = _changed(tuple(v for row in rotation for v in row), k)
        yield Command(position, (flat[:3], flat[3:6], flat[6:]), own, near)
    for k in range(len(near)):
        yield Command(position, rotation, own, _changed(near, k))
    for k in range(one.robot.BRANCHES):
        yield Command(position, rotation, (*own[:k], 4, *own[k + 1 :]), near)
    for row, column in product(range(3), repeat=2):
        shear = np.zeros((3, 3))
        shear[row, column] = shear[column, row] = _SHEAR
        turned = np.array(rotation) @ (np.eye(3) + shear)
        yield Command(position, tuple(map(tuple, turned.tolist())), own, near)
    mirrored = np.array(rotation) @ np.diag([1.0, 1.0, -1.0])
    yield Command(position, tuple(map(tuple, mirrored.tolist())), own, near)
    yield Command(position, HALF_TURN, own, near)
    above = (*position[:2], position[2] + 1.0)  # a planar machine refuses it in all branches together
    yield Command(above, rotation, (0,) * len(own), near)
    yield Command(_changed(position, 0), rotation, (0,) * len(own), near)


def _changed(values: tuple[float, ...], place: int) -> tuple[float, ...]:
    return (*values[:place], float("nan"), *values[place + 1 :])
