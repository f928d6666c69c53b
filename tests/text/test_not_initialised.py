"""Before Initialize, and after one that refused, no method works: a status, and outputs untouched."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from tests.text.any_method import Call, call_of, methods_of
from tests.text.controller import NOT_INITIALIZED, OK, Controller
from tests.text.pairs import Pair
from tests.text.serial_pairs import SerialPair
from tests.text.test_garbage import MOTIONS

State = dict[str, dict[Any, Any]]
INDEPENDENT = {
    "GetKinematicsName", "GetConfigurationDataSize", "GetDefaultConfigurationData", "CPConnectible",
    "ActivateAutomaticRotaryPeriods", "IsConfigSingular", "GetPeriods", "AxisSettings",
}  # fmt: skip
"""Methods that need no parameter, and work as ever: AxisSettings keeps what it is given for Initialize."""


def is_free(result: Any, before: State, after: State) -> bool:
    """Whether the axis is said to have no limits."""
    return after["props"]["limits", "xUnlimited"] is True


def is_unknown(result: Any, before: State, after: State) -> bool:
    """Whether only the freedom of the orientation was written, as unknown."""
    return after["oriInfo"] == before["oriInfo"] | {("dof",): "three"}


def is_automatic(result: Any, before: State, after: State) -> bool:
    """Whether every byte leaves its branch or turn open."""
    return set(after["cd"].values()) == {0}


NEUTRAL: dict[str, Callable[[Any, State, State], bool]] = {
    "InitializeReason": lambda result, before, after: result != "",
    "IsInitialized": lambda result, before, after: result is False,
    "Diagnose": lambda result, before, after: result == "not initialized",
    "IsSingularity": lambda result, before, after: result is True,
    "GetAxisProperties": is_free,
    "GetOrientationImage": is_unknown,
    "AxesToConfiguration_Offset": is_automatic,
}
"""What methods without a status answer."""


def fresh(one: SerialPair) -> Controller:
    """A block that was never initialised."""
    return Controller(one.library, one.mechanism)


def refused(one: SerialPair) -> Controller:
    """A block that was initialised, and then refused other inputs."""
    controller = fresh(one)
    assert controller.initialise(one.robot.parameters) == OK
    assert controller.initialise({"offset_" + one.mechanism.joints[-1].key: math.inf}) == NOT_INITIALIZED
    return controller


@pytest.mark.parametrize("made", [fresh, refused])
def test_no_method_works(pairs: tuple[Pair, ...], made: Callable[[SerialPair], Controller]) -> None:
    """No method works before Initialize, and outputs stay as they are."""
    one = pairs[-1]
    controller = made(one)
    for method in methods_of(controller):
        call = call_of(one, controller, method, one.regular[0])
        before = call.state()
        result, after = call.run()
        if method in INDEPENDENT:
            assert (result, after) == working(one, call, method)
        elif found := MOTIONS.get(method.removesuffix("From")):
            assert result == NOT_INITIALIZED and set(after[found].values()) == {0.0}
        elif call.has_status:
            assert (result, after) == (NOT_INITIALIZED, before), method
        else:
            assert NEUTRAL[method](result, before, after), f"{method} {result} {after}"


def working(one: SerialPair, call: Call, method: str) -> tuple[Any, State]:
    """What the same method of an initialised block answers."""
    return call_of(one, one.controller, method, one.regular[0]).run()
