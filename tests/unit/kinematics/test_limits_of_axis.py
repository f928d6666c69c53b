"""Programs of a machine: limits and rates are what plain numbers and differences say, and nothing is set up twice."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest
import sympy as sp
from hypothesis import assume, given
from hypothesis import strategies as st

from derive.description.catalogue import MECHANISMS, load
from derive.equations.windows import limits_of_axis
from derive.ir.constants import LARGEST, LIMIT
from derive.ir.interpret import Array, run
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Root, Select, Wrap
from derive.ir.program import Iterate, Let, Output, Solve, Statement, Status
from derive.ir.symbols import Names, flag, real
from derive.ir.verify import BrokenProgram
from derive.kinematics.build import build
from derive.kinematics.rates import Rates
from derive.kinematics.search.slopes import slope_name, with_slopes
from tests.unit.kinematics.machine import machine

PROGRAM = limits_of_axis()
NOT_A_NUMBER = math.nan
Range = tuple[float, float] | None

numbers = st.one_of(st.sampled_from([-180.0, -175.0, 0.0, 170.0, 175.0, 180.0, 540.0]), st.floats(-1e3, 1e3))
huge = st.sampled_from([math.inf, -math.inf, 1e300, -1e300, 1e9, -1e9])
ranges = st.tuples(numbers, numbers).filter(lambda r: r[0] < r[1])
drives = st.tuples(st.one_of(numbers, huge), st.one_of(numbers, huge)).filter(lambda r: r[0] <= r[1])


def both(own: Range, drive: Range) -> tuple[dict[str, float], Status]:
    """The outputs of the program. Without a range the ends of the block are zeros, and those of the drive are NaN."""
    low, high = own or (0.0, 0.0)
    lower, upper = drive or (NOT_A_NUMBER, NOT_A_NUMBER)
    values = {"own_unlimited": float(own is None), "own_lower": low, "own_upper": high}
    values |= {"drive_limited": float(drive is not None), "drive_lower": lower, "drive_upper": upper}
    found, status = run(PROGRAM, {name: np.asarray(value) for name, value in values.items()})
    return {name: float(value) for name, value in found.items()}, status.item()


@given(own=st.none() | ranges, drive=drives)
def test_it_is_what_both_allow(own: Range, drive: tuple[float, float]) -> None:
    largest = float(LARGEST)
    low = max(drive[0], own[0] if own else -largest)
    high = min(drive[1], own[1] if own else largest)
    found, status = both(own, drive)
    assert status is (Status.OK if low <= high else Status.NOT_INITIALIZED)
    if status is Status.OK:
        tolerance = float(LIMIT) * (1.0 + abs(low) + abs(high))
        assert (found["lowest"], found["highest"]) == pytest.approx(
            (low - tolerance, high + tolerance), rel=1e-15, abs=1e-12
        )
        assert found["middle"] == pytest.approx((low + high) / 2, abs=1e-6)
        assert found["single"] == both((low, high), None)[0]["single"] or low == high


@given(limits=ranges)
def test_it_does_not_matter_who_knows_them(limits: Range) -> None:
    """The same limits in the block, in the drive, or in both."""
    assert both(limits, None) == both(None, limits) == both(limits, limits)


@pytest.mark.long
@given(lower=numbers, upper=numbers, own=st.none() | ranges)
def test_no_range_is_refused(lower: float, upper: float, own: Range) -> None:
    assume(lower > upper)
    for drive in ((lower, upper), (NOT_A_NUMBER, upper), (lower, NOT_A_NUMBER), (math.inf, -math.inf)):
        assert both(own, drive)[1] is Status.BAD_INPUT


@pytest.mark.parametrize(
    "limits", [None, (-170.0, 170.0), (-175.0, 175.0), (-175.5, 175.5), (-180.0, 180.0), (-400.0, 20.0)]
)
def test_a_drive_that_is_not_known_changes_nothing(limits: Range) -> None:
    """Then it is what `setup` computes by itself."""
    lower, upper = limits or (0.0, 0.0)
    alone = machine(load(MECHANISMS / "kin_scara2_z.py"), lower_a1=lower, upper_a1=upper).constants
    found, status = both(limits, None)
    assert status is Status.OK
    assert (found["lowest"], found["highest"]) == (alone["lowest_a1"].item(), alone["highest_a1"].item())
    assert found["single"] == alone["single_a1"].item()
    assert limits is None or found["middle"] == alone["mid_a1"].item()


T, A, B, C, M, N, SPEED, X, ANGLE, VALUE = map(
    real, ("time", "first", "second", "third", "one", "other", "speed", "x", "a", "value")
)
STEP = 1e-6
TIMES = np.array([-1.3, -0.2, 0.4, 1.1, 2.5])
STATEMENTS: dict[str, tuple[Statement, ...]] = {
    "chain": (Let(A, sp.sin(2 * T)), Let(B, A**2 * T), Let(C, B / (2 + A))),
    "root": (Let(A, T**2 + 1), Let(C, Root(A) * T)),
    "root of nothing": (Let(A, -(T**2)), Let(C, Root(A) + T)),
    "choice": (Let(A, 3 * T), Let(C, Select(sp.Gt(A, 1), A**2, A - 7))),
    "angle": (Let(A, 1 + T**2), Let(B, sp.cos(T)), Let(C, Wrap(Atan2(A, B) + 7) + sp.Abs(T))),
    "flag": (Let(flag("ahead"), sp.Gt(T, 0)), Let(C, Select(flag("ahead"), T, -(T**2)))),
    "system": (Solve((M, N), (2 + T**2, T, sp.sin(T), sp.Integer(3)), (T, 1 + T)), Let(C, M * N)),
    "constant": (Let(A, real("length") * 2), Let(C, A)),
}
LENGTH = 1.7


def rates_of(statements: tuple[Statement, ...]) -> tuple[tuple[Statement, ...], sp.Expr]:
    rates = Rates({T: SPEED}, Names(("time", "speed", "length", *(n.name for s in statements for n in s.bound()))))
    rates.through(statements)
    return tuple(rates.statements), rates.of(C)


@pytest.mark.parametrize("name", STATEMENTS)
def test_a_rate_is_the_derivative(name: str) -> None:
    statements = STATEMENTS[name]
    further, rate = rates_of(statements)
    program = normalise("rates", (*statements, *further), [Output("rate", rate)])
    values = normalise("values", statements, [Output("value", C)])

    def at(times: Array) -> Array:
        found, _ = run(values, {"time": times, "length": np.full(times.shape, LENGTH)})
        return np.broadcast_to(found["value"], times.shape)

    given = {"time": TIMES, "speed": np.full(TIMES.shape, 0.7), "length": np.full(TIMES.shape, LENGTH)}
    found, _ = run(program, given)
    expected = 0.7 * (at(TIMES + STEP) - at(TIMES - STEP)) / (2.0 * STEP)
    assert np.broadcast_to(found["rate"], TIMES.shape) == pytest.approx(expected, abs=1e-7)


def test_a_given_rate_replaces_the_statement() -> None:
    rates = Rates({A: SPEED}, Names(("time", "first", "third", "speed")))
    rates.through((Let(A, sp.sin(T)), Let(C, A**2)))
    assert rates.of(C) == real("rate_of_third")
    assert rates.statements == [Let(real("rate_of_third"), 2 * A * SPEED)]


def test_what_a_loop_binds_has_no_rate_of_its_own() -> None:
    loop = Iterate((A,), (T,), (Let(B, A / 2),), (B,), sp.Lt(B, 1), 9, None)
    rates = Rates({T: SPEED}, Names(("time", "first", "second", "third", "speed")))
    rates.through((loop, Let(C, A + T)))
    with pytest.raises(BrokenProgram, match="third: nothing gives a rate"):
        rates.of(C)
    known = Rates({T: SPEED, A: 3 * SPEED}, Names(("time", "first", "second", "third", "speed")))
    known.through((loop, Let(C, A + T)))
    assert known.statements == [Let(real("rate_of_third"), 4 * SPEED)]


VALUES = {
    "size": sp.Abs(X**2 - 2) * X,
    "divided by a size": 3 * sp.sin(X) / sp.Abs(ANGLE * X - ANGLE),
    "root": Root(X**2 + ANGLE),
    "choice": Select(sp.Gt(X, 1), X**3, -X),
    "size of a choice": sp.Abs(Select(sp.Gt(X, 1), ANGLE * X, sp.cos(X))),
}


@pytest.mark.parametrize("name", VALUES)
def test_a_slope_is_what_a_small_step_measures(name: str) -> None:
    lets = with_slopes([Let(VALUE, VALUES[name])], X)
    program = normalise("slopes", lets, [Output("value", VALUE), Output("slope", slope_name(VALUE))])
    x, step, a = np.array([-2.3, -0.7, 0.2, 1.3, 2.9]), 1e-6, np.full(5, 1.7)
    found, _ = run(program, {"x": x, "a": a})
    ends = [run(program, {"x": x + side * step, "a": a})[0]["value"] for side in (1, -1)]
    assert np.allclose(found["slope"], (ends[0] - ends[1]) / (2 * step), rtol=1e-7, atol=1e-7)


@pytest.mark.long
@pytest.mark.parametrize("file", ["kin_scara3_ccz.py", "kin_p2x_type1.py"])
def test_no_two_constants_have_the_same_value(file: str) -> None:
    """What the programs need, and the setup has already, is read by the name that it has."""
    setup = build(load(MECHANISMS / file)).setup
    values = Counter(let.value for let in setup.lets() if let.value.args)
    assert len(values) > 3 and not [value for value, times in values.items() if times > 1]
