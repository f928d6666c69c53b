"""Every combination of branch bytes, open and wrong ones too, at poses and beside them; limits, and open loops."""

from itertools import product

import numpy as np
import pytest

from tests.text.controller import BAD_INPUT, IMPOSSIBLE, OK, UNREACHABLE, asked, assert_same
from tests.text.pairs import Pair
from tests.text.samples import Bytes, Sample

pytestmark = pytest.mark.slow

POSES, FAR = 4, 100
BYTES = (0, 1, 2, 3)


def combinations(loop: Pair) -> list[Bytes]:
    """All branch bytes, with open turns."""
    turns = (0,) * len(loop.robot.PERIOD_AXES)
    return [(*data, *turns) for data in product(BYTES, repeat=loop.robot.BRANCHES)]


def compare(loop: Pair, position: tuple[float, ...], sample: Sample, data: Bytes) -> str:
    """Ask both for the inverse; answers the status."""
    rotation = asked(loop.robot.orientation, sample.axes)[1] or sample.rotation
    status, axes = asked(loop.robot.inverse, (position, rotation), data, sample.reference)
    expected = None if axes is None else axes + (0.0,) * (6 - len(axes))
    found = loop.controller.inverse(position, rotation, data, sample.reference)
    assert_same(found, (status, expected), loop, position, sample, data)
    return status


def test_all_branches_at_poses(loops: tuple[Pair, ...]) -> None:
    """Every combination of branch bytes is answered as in Python, at regular poses."""
    for loop in loops:
        statuses = {
            compare(loop, loop.robot.forward(sample.axes)[0].position, sample, data)
            for sample in loop.regular[:POSES]
            for data in combinations(loop)
        }
        assert OK in statuses or loop.machine.label == "limited"


def test_the_own_branch_leads_back(loops: tuple[Pair, ...]) -> None:
    """Not only what Python answers: the axis values that the pose was made of."""
    for loop in loops[:2]:
        for sample in loop.regular:
            status, (position, rotation, data) = loop.controller.forward(sample.axes)
            own = data[: len(loop.robot.CONFIGURATION)]
            status, axes = loop.controller.inverse(position, rotation, own, sample.axes)
            assert status == OK, f"{loop} {sample}"
            np.testing.assert_allclose(axes[: len(sample.axes)], sample.axes, rtol=1e-8, atol=1e-6)


def test_poses_that_may_be_out_of_reach(loops: tuple[Pair, ...]) -> None:
    """Anywhere around the machine; the own plane of a planar one, and beside it. Any rotation of what only turns."""
    rng = np.random.default_rng(21)
    for loop in loops:
        opened = combinations(loop)
        statuses = []
        for k in range(FAR):
            size = loop.machine.reach * (0.3, 1.0, 100.0)[k % 3]
            depth = 0.0 if len(loop.mechanism.task.position) == 2 and k % 10 else 1.0
            position = tuple((rng.uniform(-1.0, 1.0, 3) * size * (1.0, 1.0, depth)).tolist())
            samples = loop.regular if loop.mechanism.task.position else loop.anywhere
            statuses.append(compare(loop, position, samples[k % len(samples)], opened[k % len(opened)]))
        assert UNREACHABLE in statuses


def test_a_byte_without_a_meaning_is_refused(loops: tuple[Pair, ...]) -> None:
    """A branch byte other than 0 to 3 is refused as bad input, as in Python."""
    for loop in loops:
        default = loop.robot.DEFAULT_CONFIGURATION
        for index, byte in product(range(loop.robot.BRANCHES), (4, 127, 128, 255)):
            data = (*default[:index], byte, *default[index + 1 :])
            for sample in loop.regular[:3]:
                position = loop.robot.forward(sample.axes)[0].position
                assert compare(loop, position, sample, data) == BAD_INPUT


def test_turns(loops: tuple[Pair, ...]) -> None:
    """All period bytes that an axis can be asked for, and that cannot be met with limits."""
    for loop in loops:
        for sample in loop.regular[:3]:
            frame, own = loop.robot.forward(sample.axes)
            for index, turn in product(range(loop.robot.BRANCHES, len(own)), (-127, -2, -1, 1, 2, 127)):
                compare(loop, frame.position, sample, (*own[:index], turn, *own[index + 1 :]))


def test_a_loop_that_does_not_close_is_impossible(loops: tuple[Pair, ...]) -> None:
    """And singular."""
    for loop in loops:
        statuses = [(loop.controller.forward(s.axes)[0], loop.controller.is_singular(s.axes)) for s in loop.anywhere]
        assert all(singular for status, singular in statuses if status != OK)
        assert {status for status, _ in statuses} <= {OK, IMPOSSIBLE}
