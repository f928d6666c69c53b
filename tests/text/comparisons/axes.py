"""The axes of a block: their properties, and the limits of the drives, which narrow those of the machine."""

import numpy as np

from derive.description.mechanism import Joint, Kind
from tests.text.comparisons.poses import assert_same_pose, solved
from tests.text.controller import NOT_INITIALIZED, OK, Controller, asked, assert_same, is_close
from tests.text.pairs import Pair
from tests.text.samples import Sample
from tests.text.settings import Range, own_limits, together


def axis_properties(pair: Pair, sample: Sample) -> None:
    """Types as declared, and the limits that the block keeps; beyond the axes a free linear one."""
    for index in (*range(6), 255, 2**32 - 1):
        found = pair.controller.axis_properties(index)
        if index < len(pair.mechanism.joints):
            assert_same(found, _properties(pair, pair.mechanism.joints[index]), pair, index)
        else:
            assert found == ("Linear", True, 0.0, 0.0)


def _properties(pair: Pair, joint: Joint) -> tuple[str, bool, float, float]:
    kind = "Rotary" if joint.kind is Kind.ROTARY else "Linear"
    own = own_limits(pair.mechanism, pair.robot.parameters, joint)
    return (kind, True, 0.0, 0.0) if own is None else (kind, False, *own)


def axis_settings(pair: Pair, sample: Sample) -> None:
    """Limits of all drives around a pose narrow those of the machine: the machine with both answers
    the same in Python.
    """
    rng = np.random.default_rng(list(sample.data) or 5)
    controller = Controller(pair.library, pair.mechanism)
    drives = [drive_around(value, joint, rng) for value, joint in zip(sample.axes, pair.mechanism.joints, strict=True)]
    both = together(pair.mechanism, pair.robot.parameters, drives)
    statuses = [controller.axis_settings(index, drive) for index, drive in enumerate(drives)]
    assert set(statuses) == {OK}
    assert controller.initialise(pair.robot.parameters) == (NOT_INITIALIZED if both is None else OK)
    if both is None:
        return
    robot = type(pair.robot)(**both)
    for command, _ in solved(pair.machine, sample):
        frame = command.position, command.rotation
        status, answer = asked(robot.inverse, frame, command.configuration, command.reference)
        expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
        found = controller.inverse(*frame, command.configuration, command.reference)
        if status == OK and robot.singularity(answer).is_singular and not is_close(found, (status, expected)):
            assert_same_pose(pair, found, (status, expected), command)
            continue
        assert_same(found, (status, expected), pair, drives, command)


def drive_around(value: float, joint: Joint, rng: np.random.Generator) -> Range:
    """Limits of a drive, of less or more than a turn, about a value as far as the machine could have them; or none."""
    if rng.uniform() < 0.3:
        return None
    low, high = joint.limit_range or (-1e9, 1e9)
    below, above = rng.choice((5.0, 100.0, 170.0, 300.0), 2)
    inside = min(max(value, low + 5.0), high - 5.0)
    return max(low, inside - below), min(high, inside + above)
