"""The functions that all units share, each alone, against the reference semantics of the programs."""

import math
from typing import Any

import numpy as np
import pytest
import sympy as sp
from hypothesis import example, given
from hypothesis import strategies as st
from softkin._configuration import turn_inside

from derive.emit.st.contract import load
from derive.ir.interpret import evaluate
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root
from derive.ir.program import Status
from derive.ir.symbols import real
from tests.harness.library import Library, StFault
from tests.text.units import compiled_shared

LIBRARY = compiled_shared()
HUGE = 1e300
SIZES = st.floats(-HUGE, HUGE) | st.floats(-1e9, 1e9) | st.sampled_from([0.0, -0.0, 5e-324, -5e-324, 1.0, -1.0])
DEGREES = st.floats(-1e9, 1e9) | st.integers(-2000, 2000).map(lambda n: 90.0 * n)
ANGLES = st.floats(-1e4, 1e4) | st.integers(-40, 40).map(lambda n: n * math.pi / 2)
NO_NUMBERS = (math.nan, math.inf, -math.inf, 1e300, -1e300, 1.0000001e9, -1.0000001e9)
ROUNDING = 4.5e-16
"""Two units in the last place."""


def reference(function: type[sp.Function], *arguments: float) -> float:
    """The value of a primitive, as the programs define it."""
    symbols = [real(f"argument_{i}") for i, _ in enumerate(arguments)]
    return float(evaluate(function(*symbols), {s.name: np.asarray(v) for s, v in zip(symbols, arguments, strict=True)}))


@given(y=SIZES, x=SIZES)
@example(-0.0, -1.0)
@example(0.0, -0.0)
@example(-5e-324, -1.0)
@example(HUGE, 5e-324)
def test_atan2(y: float, x: float) -> None:
    found = LIBRARY.function("Softkin_Atan2")(y, x)
    assert found == pytest.approx(reference(Atan2, y, x), rel=ROUNDING, abs=5e-324)
    assert -math.pi <= found <= math.pi


@given(value=SIZES)
def test_root(value: float) -> None:
    assert LIBRARY.function("Softkin_Root")(value) == reference(Root, value)


def test_nearest_period_of_what_has_no_turn() -> None:
    """Beyond the turns that an integer counts a value has no digits left for its turn: about half a turn is left."""
    for size in (1e12, -1e12, 1e15):
        assert abs(LIBRARY.function("Softkin_NearestPeriod")(size, 0.0)) <= 181.0


@given(value=DEGREES, centre=DEGREES)
@example(180.0, 0.0)
@example(-180.0, 0.0)
@example(180.0 - 1e-9, 0.0)
@example(180.0 - 1.1e-9, 0.0)
@example(540.0, 360.0)
def test_nearest_period(value: float, centre: float) -> None:
    assert LIBRARY.function("Softkin_NearestPeriod")(value, centre) == reference(NearestPeriod, value, centre)


@given(angle=ANGLES, centre=ANGLES, half=st.floats(0.0, math.pi))
def test_nearest_on_arc(angle: float, centre: float, half: float) -> None:
    expected = reference(NearestOnArc, angle, centre, half)
    assert LIBRARY.function("Softkin_NearestOnArc")(angle, centre, half) == pytest.approx(
        expected, rel=1e-14, abs=1e-14
    )


@given(value=st.floats(-2e9, 2e9) | st.integers(-(2**31), 2**31).map(float))
@example(-0.5)
@example(-1e-300)
@example(2e9)
@example(-2e9)
def test_floor(value: float) -> None:
    if abs(value) <= 2e9:
        assert LIBRARY.function("Softkin_Floor")(value) == math.floor(value)


@given(value=st.floats(2.1e9, HUGE) | st.floats(-HUGE, -2.1e9))
@example(math.nextafter(2e9, math.inf))
def test_floor_leaves_what_no_integer_holds(value: float) -> None:
    assert LIBRARY.function("Softkin_Floor")(value) == value


@given(axis=st.floats(-1e9, 1e9) | st.integers(-300, 300).map(lambda n: 180.0 * n))
@example(180.0 - 1e-9)
@example(-180.0 - 1e-9)
@example(math.nextafter(180.0, 0.0))
@example(360.0 * 127 - 180.0 - 1e-3)
@example(360.0 * 127 - 180.0)
@example(-180.0 - 360.0 * 127)
@example(-180.0 - 360.0 * 127 - 1e-3)
def test_period_number(axis: float) -> None:
    turn = math.floor((axis + (180.0 + 1e-9)) / 360.0)
    number = turn + 1 if turn >= 0 else turn
    assert LIBRARY.function("Softkin_PeriodNumber")(axis) == (number if abs(number) <= 127 else 0)


@given(axis=st.floats(-5000.0, 5000.0), low=st.floats(-2000.0, 2000.0), width=st.floats(0.1, 2000.0))
@example(181.0, -180.0, 360.0)
@example(-180.5, -180.0, 360.0)
@example(100.0, 185.0, 5.0)
@example(1e5, -1e5, 1.5e5)
@example(-1e5, -9e4, 1.5e5)
@example(3e5, 2e5, 8e4)
@example(-3e5, -2.8e5, 8e4)
def test_the_turn_inside(axis: float, low: float, width: float) -> None:
    """Of the turns that a byte can name, the one inside that is nearest to the end which the axis is beyond."""
    high = low + width
    if low <= axis <= high:
        return
    numbers = [n for n in range(-127, 128) if n != 0]
    turns = {n: axis + 360.0 * round((_centre(n) - axis) / 360.0) for n in numbers}
    inside = [n for n, value in turns.items() if low <= value <= high]
    edges = (
        (value, edge) for n, value in turns.items() for edge in (low, high, _centre(n) - 180.0, _centre(n) + 180.0)
    )
    if any(abs(value - edge) < 1e-6 for value, edge in edges):
        return  # where rounding decides
    expected = (max(inside) if axis > high else min(inside)) if inside else 0
    assert LIBRARY.function("Softkin_TurnInside")(axis, low, high) == turn_inside(axis, low, high) == expected


def _centre(number: int) -> float:
    return 360.0 * (number - 1 if number > 0 else number)


def test_period_numbers_and_bytes() -> None:
    """Each of the 255 numbers that a byte holds, and no other."""
    to_byte, of_byte = LIBRARY.function("Softkin_ByteOfPeriod"), LIBRARY.function("Softkin_PeriodOfByte")
    for number in range(-127, 128):
        assert to_byte(number) == number % 256
        assert of_byte(to_byte(number)) == number
    for number in (-32768, -129, -128, 128, 129, 255, 256, 32767):
        assert to_byte(number) == 0
    assert [of_byte(byte) for byte in range(256)] == [*range(128), *range(-128, 0)]


@given(margin=st.floats(-1e300, 1e300))
@example(1e-11)
@example(-1e-11)
@example(1.0000001e-11)
@example(-1.0000001e-11)
@example(0.0)
def test_branch_byte(margin: float) -> None:
    """The branch byte is 3 where branches coincide, else 1 or 2 by the sign of the margin."""
    expected = 3 if abs(margin) <= 1e-11 else (1 if margin > 0 else 2)
    assert LIBRARY.function("Softkin_BranchByte")(margin) == expected


def test_the_distance_from_a_reference() -> None:
    """The sum of squares over the axes that are compared; 0 where the reference of one of them is no number."""
    found = LIBRARY.new("TRAFO.AXISPOS_REF")
    near = LIBRARY.new("TRAFO.AXISPOS_REF")
    for k in range(6):
        setattr(found, f"a{k}", 10.0 * k)
        setattr(near, f"a{k}", float(k))
    distance = LIBRARY.function("Softkin_Distance")
    every = [True] * 6
    assert distance(a=found, aRef=near, aCompared=every) == sum((9.0 * k) ** 2 for k in range(6))
    assert distance(a=found, aRef=near, aCompared=[False, True, False, False, False, True]) == 81.0 + 45.0**2
    for wrong in NO_NUMBERS:
        near.a4 = wrong
        assert distance(a=found, aRef=near, aCompared=every) == 0.0
        assert distance(a=found, aRef=near, aCompared=[True, True, False, False, False, False]) == 81.0


def test_the_harness_would_notice_a_bad_operation() -> None:
    """Without its guard, a function faults: the tests above can fail."""
    with pytest.raises(StFault):
        LIBRARY.function("Softkin_Atan2")(math.nan, 1.0)


def test_the_status_of_a_number() -> None:
    """The answers of our blocks are numbered in the order of the statuses."""
    status_of = LIBRARY.function("Softkin_StatusOf")
    answers = [status.value for status in Status]
    assert [status_of(number) for number, _ in enumerate(answers)] == answers


def axis_of(library: Library, **members: object) -> Any:
    """The structure of an axis with these members."""
    made = library.new("Softkin_Axis")
    for name, value in members.items():
        setattr(made, name, value)
    return made


def test_the_range_of_an_axis() -> None:
    """The narrower of both limits; one turn is inside where the joint, behind its gear, turns at most 350 degrees."""
    library = compiled_shared()
    for turns, high, is_single in ((1.0, 349.0, True), (2.0, 349.0, False), (2.0, 170.0, True)):
        axis = axis_of(library, hasTurns=True, turns=turns, lower=0.0, upper=high)
        drive = {"xKnown": True, "xLimited": True, "dLower": -10.0, "dUpper": 1000.0}
        assert library.function("Softkin_SetAxis")(axis=axis, **drive) == "SMC_NO_ERROR"
        assert (axis.lowest, axis.highest) == pytest.approx((0.0, high), abs=1e-6)
        assert axis.isSingle is is_single and (axis.middle > 0.0) is is_single


def test_an_axis_beyond_its_range() -> None:
    """Below, above, and on another turn that is inside, each with its number and the missing amount."""
    library = compiled_shared()
    beyond = library.function("Softkin_Beyond")
    turning = axis_of(library, hasTurns=True, lowest=-100.0, highest=100.0)
    linear = axis_of(library, lowest=-100.0, highest=100.0)
    cases = [
        (turning, -110.0, 4, 10.0, 0),
        (turning, 120.0, 6, 20.0, 0),
        (turning, 360.0, 5, 260.0, 1),
        (linear, 130.0, 5, 30.0, 0),
        (linear, -130.0, 4, 30.0, 0),
    ]
    for axis, value, reason, missing, turn in cases:
        found, outputs = beyond.with_outputs(axis=axis, dValue=value, iFirst=4)
        assert (found, outputs["dMissing"], outputs["iTurn"]) == (reason, missing, turn)


def test_the_reasons_of_limits() -> None:
    """One for each axis, and none for what is no axis."""
    reason = compiled_shared().function("Softkin_LimitsReason")
    assert len({reason(udiAxis=k) for k in range(6)}) == 6 and reason(udiAxis=6) == ""


def test_the_byte_of_a_choice() -> None:
    """The first branch, the second one, and that nearest to the reference, whatever is chosen beside it."""
    byte = compiled_shared().function("Softkin_ByteOfChoice")
    found = [byte(first, automatic) for automatic in (False, True) for first in (True, False)]
    assert found == [1, 2, 0, 0]


def test_the_reasons_of_bytes() -> None:
    """One for each byte of a branch, and none for what is no byte."""
    reason = compiled_shared().function("Softkin_ByteReason")
    assert len({reason(iByte=k) for k in range(8)}) == 8 and reason(iByte=8) == ""


def test_the_base_alone_supplies_nothing() -> None:
    """Every protected method of the base that a geometry supplies answers that it is impossible, and writes nothing."""
    made = compiled_shared().new("Softkin_Kinematics")
    supplied = set(map(str.lower, load().supplied))
    for name, entry in made.routines.items():
        if name in supplied:
            given = {
                p.name: make()
                for p, make in zip(entry.routine.parameters, entry.defaults, strict=True)
                if p.scope != "VAR_OUTPUT"
            }
            refused = "impossible" if name == "reasonof" else "SMC_TRAFO_INVALID_CONSTELLATION"
            assert made.call(name, **given) == refused, name
    assert made.call("Initialize") == "SMC_TRAFO_INVALID_CONSTELLATION"
    assert made.call("InitializeReason") == "not initialized"
