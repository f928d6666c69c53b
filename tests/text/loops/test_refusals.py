"""Parameters that form no machine, numbers that are none, blocks that were not initialised: a status, outputs
untouched."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.text import test_initialise
from tests.text.comparisons import POSELESS
from tests.text.controller import IMPOSSIBLE, NOT_INITIALIZED, OK, UNREACHABLE, Controller
from tests.text.loops.answers import COMPARISONS
from tests.text.loops.machines import Loop
from tests.text.units import compiled

pytestmark = pytest.mark.slow


def test_limits_are_in_order(loops: tuple[Loop, ...]) -> None:
    """Initialize refuses a lower limit that is not below the upper one."""
    for joint in loops[0].mechanism.joints:
        for lower, upper, expected in ((10.0, 10.0, NOT_INITIALIZED), (10.0, -10.0, NOT_INITIALIZED), (-5.0, 10.0, OK)):
            given = {**loops[0].robot.parameters, f"lower_{joint.key}": lower, f"upper_{joint.key}": upper}
            assert Controller(loops[0].library, loops[0].mechanism).initialise(given) == expected


def test_without_inputs_a_machine_is_refused(loops: tuple[Loop, ...]) -> None:
    """Its lengths have no defaults."""
    block = Controller(loops[0].library, loops[0].mechanism).block
    assert block.call("Initialize") == NOT_INITIALIZED
    assert not block.call("IsInitialized")


@pytest.mark.parametrize("size", [36, 80])
def test_a_matrix_of_another_size_is_refused(loops: tuple[Loop, ...], size: int) -> None:
    """Initialize refuses a library whose matrix has another size."""
    controller = Controller(compiled(loops[0].mechanism, matrix_size=size), loops[0].mechanism)
    assert controller.initialise(loops[0].robot.parameters) == NOT_INITIALIZED


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


def test_a_configuration_that_is_too_small_is_refused(loops: tuple[Loop, ...]) -> None:
    """Initialize refuses a library whose configuration has too few bytes."""
    if len(loops[0].robot.CONFIGURATION) > 1:
        controller = Controller(test_initialise.without_index_checks(loops[0].mechanism), loops[0].mechanism)
        assert controller.initialise(loops[0].robot.parameters) == NOT_INITIALIZED


def test_every_method_answers_the_same_by_columns(loops: tuple[Loop, ...]) -> None:
    """The matrix of the controller's library stored the other way."""
    for loop in loops[1:]:
        controller = Controller(compiled(loop.mechanism, "columns"), loop.mechanism)
        assert controller.initialise(loop.robot.parameters) == OK
        assert controller.block.matrixOrder.lower() == "columns"
        other = replace(loop, controller=controller)
        for sample in loop.regular[:8]:
            assert controller.forward(sample.axes) == loop.controller.forward(sample.axes)
            for method in COMPARISONS.keys() - POSELESS:
                if method.lower() in controller.methods:
                    COMPARISONS[method](other, sample)


def test_a_loop_that_does_not_close_is_impossible(loops: tuple[Loop, ...]) -> None:
    """And singular."""
    for loop in loops:
        statuses = [(loop.controller.forward(s.axes)[0], loop.controller.is_singular(s.axes)) for s in loop.any]
        assert all(singular for status, singular in statuses if status != OK)
        assert {status for status, _ in statuses} <= {OK, IMPOSSIBLE}
