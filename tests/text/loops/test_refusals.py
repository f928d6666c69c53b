"""Limits, and loops that do not close: a status for each."""

import pytest

from tests.text.controller import IMPOSSIBLE, OK, UNREACHABLE, Controller
from tests.text.loops.machines import Loop

pytestmark = pytest.mark.slow


def test_every_limit_refuses_alone(loops: tuple[Loop, ...]) -> None:
    """Either end of every axis, and not where limits are not checked."""
    loop = loops[1]
    sample = loop.regular[0]
    position, rotation, data = loop.controller.forward(sample.axes)[1]
    own = data[: len(loop.robot.CONFIGURATION)]
    for joint, value in zip(loop.mechanism.joints, sample.axes, strict=True):
        for lower, upper, expected in (
            (value - 1.0, value + 1.0, OK),
            (value + 1e-3, value + 1.0, UNREACHABLE),
            (value - 1.0, value - 1e-3, UNREACHABLE),
        ):
            limits = {f"lower_{joint.key}": lower, f"upper_{joint.key}": upper}
            for checked, answer in ((True, expected), (False, OK)):
                controller = Controller(loop.library, loop.mechanism)
                assert controller.initialise({**loop.robot.parameters, **limits, "check_limits": checked}) == OK
                assert controller.inverse(position, rotation, own, sample.axes)[0] == answer
                reason, missing = controller.diagnose(position, rotation, own, sample.axes)
                assert (answer == UNREACHABLE) == reason.startswith(f"{joint.name}: ") == ("limit [" in reason)
                assert missing == pytest.approx(0.0 if answer == OK else 1e-3, abs=1e-5)


def test_a_loop_that_does_not_close_is_impossible(loops: tuple[Loop, ...]) -> None:
    """And singular."""
    for loop in loops:
        statuses = [(loop.controller.forward(s.axes)[0], loop.controller.is_singular(s.axes)) for s in loop.any]
        assert all(singular for status, singular in statuses if status != OK)
        assert {status for status, _ in statuses} <= {OK, IMPOSSIBLE}
