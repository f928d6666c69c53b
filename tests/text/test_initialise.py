"""Initialize: what it refuses, and that no method works before it or after one that refused."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import pytest
import softkin

from derive.description.mechanism import Mechanism, Parameter, Role
from derive.kinematics.parameters import machine_parameters
from tests.catalogue.machines import LENGTHS
from tests.harness.library import Library, StError
from tests.text.any_method import Call, call_of, methods_of
from tests.text.controller import NOT_INITIALIZED, OK, Controller, asked
from tests.text.pairs import MECHANISMS, Pair, pairs_of
from tests.text.test_garbage import MOTIONS
from tests.text.units import compiled, compiled_text, file_of, text_of

NO_NUMBERS = (math.nan, math.inf, -math.inf, 1e300, -1e300)


def wrong_values(parameter: Parameter) -> Iterator[float]:
    """Values outside a parameter's range, the nearest ones among them."""
    if parameter.role is Role.FLAG:
        return
    if parameter.role is Role.SIGN:
        yield from (0, 2, -2, 32767, -32768)
        return
    yield from NO_NUMBERS
    yield parameter.low if parameter.low_open else math.nextafter(parameter.low, -math.inf)
    yield math.nextafter(parameter.high, math.inf)
    if parameter.role is Role.LENGTH:
        yield from (0.0, -parameter.nominal)
    if parameter.role is Role.SIGNED_LENGTH:
        yield 0.0


@pytest.mark.slow("Hexa")
@pytest.mark.long("P2C", "Pos_RRR")
def test_every_parameter_is_checked(pairs: tuple[Pair, ...]) -> None:
    for one in pairs[-3::2]:
        given = dict(one.robot.parameters)
        for parameter in machine_parameters(one.mechanism):
            controller = Controller(one.library, one.mechanism)
            for value in wrong_values(parameter):
                assert controller.initialise(given) == OK
                wrong = given | {parameter.name: value}
                assert controller.initialise(wrong) == NOT_INITIALIZED, f"{one.mechanism.name} {parameter.name} {value}"
                assert controller.block.call("IsInitialized") is False
                assert asked(partial(type(one.robot), **wrong))[0] == NOT_INITIALIZED


@pytest.mark.long("Hexapod")
def test_the_ends_of_a_range_belong_to_it(pairs: tuple[Pair, ...]) -> None:
    """As far as the other parameters allow: Python knows."""
    accepted = 0
    for one in (pairs[0], pairs[1], pairs[-3]):
        given = dict(one.robot.parameters)
        for parameter in machine_parameters(one.mechanism):
            for value in (parameter.low, parameter.high):
                wanted = given | {parameter.name: value}
                expected, _ = asked(partial(type(one.robot), **wanted))
                status = Controller(one.library, one.mechanism).initialise(as_integers(parameter, wanted))
                assert status == expected, f"{one.mechanism.name} {parameter.name} {value}"
                accepted += status == OK
    assert accepted > len(pairs[0].mechanism.joints)


def as_integers(parameter: Parameter, given: dict[str, float]) -> dict[str, float]:
    """The parameters, a sign among them as the integer that its input takes."""
    return given | {parameter.name: int(given[parameter.name])} if parameter.role is Role.SIGN else given


@pytest.mark.parametrize(("lower", "upper"), [(10.0, 10.0), (10.0, -10.0), (0.0, -10.0), (10.0, 0.0), (0.2, 0.2)])
def test_limits_are_in_order(pairs: tuple[Pair, ...], lower: float, upper: float) -> None:
    one, mechanism = pairs[0], pairs[0].mechanism
    for key in (*(j.key for j in mechanism.joints), *(q.name for q in mechanism.limited)):
        wrong = {f"lower_{key}": lower, f"upper_{key}": upper}
        assert Controller(one.library, mechanism).initialise({**one.robot.parameters, **wrong}) == NOT_INITIALIZED
        right = {f"lower_{key}": min(lower, upper) - 1.0, f"upper_{key}": max(lower, upper)}
        assert Controller(one.library, mechanism).initialise({**one.robot.parameters, **right}) == OK


def test_the_coupling_is_given_once() -> None:
    """The one constraint between parameters in the catalogue."""
    (mechanism,) = (m for m in MECHANISMS if m.constraints)
    machine = pairs_of(mechanism)[0]
    given = {**machine.robot.parameters, "pitch_zc": 20.0}
    assert Controller(machine.library, mechanism).initialise(given) == OK
    assert Controller(machine.library, mechanism).initialise(given | {"gear_coupling": 1e-9}) == NOT_INITIALIZED


def test_a_length_has_no_default(pairs: tuple[Pair, ...]) -> None:
    mechanism = pairs[0].mechanism
    has_length = any(p.role in LENGTHS or p.default is None for p in mechanism.parameters)
    controller = Controller(compiled(mechanism), mechanism)
    assert controller.block.call("Initialize") == (NOT_INITIALIZED if has_length else OK)
    assert controller.block.call("IsInitialized") is not has_length


@pytest.mark.broad
@pytest.mark.parametrize("size", [36, 80])
def test_a_matrix_of_another_size_is_refused(pairs: tuple[Pair, ...], size: int) -> None:
    mechanism = pairs[0].mechanism
    controller = Controller(compiled(mechanism, matrix_size=size), mechanism)
    assert controller.initialise(pairs[0].robot.parameters) == NOT_INITIALIZED
    assert controller.block.call("IsInitialized") is False


@pytest.mark.broad
@pytest.mark.long
def test_a_configuration_that_is_too_small_is_refused(pairs: tuple[Pair, ...]) -> None:
    """By a compiler that looks at indices, and by Initialize where the compiler does not."""
    mechanism, given = pairs[0].mechanism, pairs[0].robot.parameters
    size = len(pairs[0].robot.CONFIGURATION)
    if size > 0:
        just_enough = Controller(compiled(mechanism, max_config_data=size - 1), mechanism)
        assert just_enough.initialise(given) == OK
    if size > 1:
        with pytest.raises(StError, match="outside"):
            compiled(mechanism, max_config_data=size - 2)
        assert Controller(without_index_checks(mechanism), mechanism).initialise(given) == NOT_INITIALIZED


def without_index_checks(mechanism: Mechanism) -> Library:
    """A unit and a CONFIGDATA that is one byte too small, for a compiler that cannot know it: no
    index is a constant.
    """
    size = len(softkin.catalogue()[mechanism.name].CONFIGURATION)
    text, count = re.subn(r"(abyData\[)(\d+\])", r"\1origin + \2", text_of(mechanism))
    assert count > 0
    text += "\nVAR_GLOBAL\n  origin : INT;\nEND_VAR\n"
    return compiled_text(file_of(mechanism), text, max_config_data=size - 2)


def test_inputs_have_no_influence_after_initialize(serial_pairs: tuple[Pair, ...]) -> None:
    """No number, nor the other direction, nor the limits."""
    for one in serial_pairs[-3:]:
        controller = Controller(one.library, one.mechanism)
        assert controller.initialise(one.robot.parameters) == OK
        controller.set_inputs(
            {p.name: spoiled(p, one.robot.parameters[p.name]) for p in machine_parameters(one.mechanism)}
        )
        for method in methods_of(controller):
            for sample in one.regular[:5]:
                expected = call_of(one, one.controller, method, sample).run()
                assert call_of(one, controller, method, sample).run() == expected, method


def spoiled(parameter: Parameter, value: float) -> float:
    """A value that the machine does not have: the other side of a flag, the other sign, or no number."""
    if parameter.role is Role.FLAG:
        return 1.0 - value
    return -value if parameter.role is Role.SIGN else math.nan


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
    "IsCompatibleWithPosKin": lambda result, before, after: result is False,
    "GetAxisProperties": is_free,
    "GetOrientationImage": is_unknown,
    "AxesToConfiguration_Offset": is_automatic,
}
"""What methods without a status answer."""


def fresh(one: Pair) -> Controller:
    """A block that was never initialised."""
    return Controller(one.library, one.mechanism)


def refused(one: Pair) -> Controller:
    """A block that was initialised, and then refused other inputs."""
    controller = fresh(one)
    assert controller.initialise(one.robot.parameters) == OK
    assert controller.initialise({"offset_" + one.mechanism.joints[-1].key: math.inf}) == NOT_INITIALIZED
    return controller


@pytest.mark.parametrize("made", [fresh, refused])
def test_no_method_works(pairs: tuple[Pair, ...], made: Callable[[Pair], Controller]) -> None:
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


def working(one: Pair, call: Call, method: str) -> tuple[Any, State]:
    return call_of(one, one.controller, method, one.regular[0]).run()
