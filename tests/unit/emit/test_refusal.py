"""Bodies on plain numbers that refuse with a diagnosis, and bytes of a configuration, run as they are printed."""

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from softkin import Diagnosis, Status
from softkin._batch import _periods
from softkin._columns import configurations
from softkin._configuration import branch_byte, period, slots, turn_inside
from softkin._input import bytes_of, reals, rotation_by_rows
from softkin._scalar import cos, sqrt
from softkin._table import numbers, whole_numbers
from softkin._types import KinematicsError

from derive.emit.python.printer import primitives_in
from derive.emit.python.program import Argument, Method, scalar_body
from derive.emit.python.refusal import explained
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Output, Program, Require
from derive.ir.program import Status as Outcome
from derive.ir.reason import OtherTurn, Unit, Why, about, about_joint
from derive.ir.symbols import real
from derive.report.reasons import Reasons

X, Y, Q1 = (real(n) for n in ("x", "y", "q1"))
REASONS = Reasons({"q1": "A1"})


def lines_of(program: Program, names: tuple[str, ...] = ("x", "y")) -> list[str]:
    kind = "Reals" if program.outputs else ""
    method = Method(
        "m", "", program, (Argument("given", "Reals", names),), kind, tuple(o.name for o in program.outputs)
    )
    return scalar_body(method, explained(REASONS))


def called(program: Program, *given: float, names: tuple[str, ...] = ("x", "y")) -> Any:
    scope: dict[str, Any] = {
        "Diagnosis": Diagnosis,
        "Status": Status,
        "sqrt": sqrt,
        "cos": cos,
        "turn_inside": turn_inside,
    }
    text = "\n".join(["def f(given):", *(f"    {line}" for line in lines_of(program, names))])
    exec(text, scope)
    return scope["f"](given)


def test_a_refusal_names_the_axis_and_the_amount() -> None:
    require = Require(sp.Gt(X, 1), Outcome.UNREACHABLE, reason=about_joint(Q1, Why.OUT_OF_REACH, 1 - X, Unit.LENGTH))
    program = normalise("p", [require], [Output("o", X + Y)])
    assert called(program, 3.0, 4.0) == (7.0,)
    assert called(program, -2.0, 4.0) == Diagnosis(Status.UNREACHABLE, "A1: out of reach [u]", 3.0)


def test_an_amount_does_not_keep_values_out_of_a_choice() -> None:
    """What one side alone needs is computed there alone, although an amount reads it behind: that writes it out."""
    far, length, angle = sp.Gt(X, 0), real("length"), real("angle")
    lets = [
        Let(length, Root(X**2 + Y**2)),
        Let(angle, sp.cos(Y)),
        Let(real("u"), Select(far, X / (1 + length), angle)),
        Let(real("v"), Select(far, Y / (1 + length), angle * 2)),
    ]
    size = real("u") ** 2 + real("v") ** 2
    require = Require(sp.Le(size, 2), Outcome.UNREACHABLE, reason=about("the pose", Why.TOO_LARGE, angle + length))
    program = normalise("p", [*lets, require], [Output("o", real("u") + real("v"))])
    lines = lines_of(program)
    choice = next(k for k, line in enumerate(lines) if line.startswith("if x > 0"))
    assert not any(line.startswith(("length =", "angle =")) for line in lines), lines
    assert any(line.startswith("    length =") for line in lines[choice:]), lines
    refused = called(program, -1.0, 0.25)
    assert refused.reason == "the pose: too large"
    assert refused.missing == pytest.approx(float(sp.cos(0.25)) + 1.0625**0.5)
    assert called(program, 3.0, 4.0) == (pytest.approx(7.0 / 6.0),)


@pytest.mark.parametrize(
    ("axis", "turn", "words"), [(400.0, 1, "this turn is beyond a limit"), (100.0, 0, "above its")]
)
def test_another_turn_is_named(axis: float, turn: int, words: str) -> None:
    """A refused axis names a turn inside the limits where there is one, else the limit that it exceeds."""
    turns = (OtherTurn("A1", X, (sp.Integer(0),), (Y,)),)
    reason = replace(about_joint(Q1, Why.ABOVE, X - Y, Unit.ANGLE), turns=turns)
    program = normalise("p", [Require(sp.Le(X, Y), Outcome.UNREACHABLE, reason=reason)], [])
    found = called(program, axis, 50.0)
    assert (found.status, found.turn, found.missing) == (Status.UNREACHABLE, turn, axis - 50.0)
    assert words in found.reason and found.reason.startswith("A1: ") and found.reason.endswith(" [deg]")
    assert called(program, 50.0, 50.0) is None


def test_a_refusal_without_a_reason_is_none_of_the_inverse() -> None:
    program = normalise("p", [Require(sp.Gt(X, 0), Outcome.UNREACHABLE)], [Output("o", X)])
    with pytest.raises(TypeError, match="gives no reason"):
        lines_of(program)


def test_words_of_a_text_are_no_calls() -> None:
    assert primitives_in(['return Diagnosis(Status.OK, "the root of cos", 0.0)', "x = sin(y)  # cos"]) == ["sin"]


@pytest.mark.long
@given(axis=st.floats(-45000.0, 45000.0))
def test_a_period_is_the_interval_that_holds_the_axis(axis: float) -> None:
    number = period(axis)
    assert number != 0
    start = -180.0 + 360.0 * (number - 1 if number > 0 else number)
    assert start - 1e-9 <= axis + 1e-9 and axis < start + 360.0


@given(axis=st.floats(-1e9, 1e9))
def test_periods_of_arrays_are_those_of_numbers(axis: float) -> None:
    assert _periods(np.array([axis]))[0] == period(axis)


def test_a_period_that_no_byte_can_hold_is_open() -> None:
    assert (period(360.0 * 126), period(360.0 * 127), period(-360.0 * 127), period(-360.0 * 128)) == (127, 0, -127, 0)


def test_first_byte_varies_fastest() -> None:
    """The slots are in the order in which the first byte varies fastest, with the sign +1 for byte 1."""
    found = slots((0, 3))
    assert [branches for branches, _ in found] == [(1, 1), (2, 1), (1, 2), (2, 2)]
    assert [signs for _, signs in found] == [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)]
    assert [branches for branches, _ in slots((2, 0))] == [(2, 1), (2, 2)]
    assert slots(()) == (((), ()),)


def test_branch_bytes() -> None:
    assert [branch_byte(m) for m in (0.5, -0.5, 1e-11, -1e-11, 0.0)] == [1, 2, 3, 3, 3]


@given(byte=st.integers(-128, 255))
def test_bytes_are_signed(byte: int) -> None:
    expected = byte - 256 if byte > 127 else byte
    assert bytes_of([byte, 1], 2) == (expected, 1)
    robot = SimpleNamespace(_branch_bytes=[1], _period_bytes=[0])
    chosen = configurations(robot, np.array([[byte, 1]]))  # type: ignore[arg-type]
    assert chosen.turns == (expected,) and chosen.are_bytes.all() and chosen.are_named.all()


NO_NUMBERS = ("123", b"\0" * 24, (1, 2), (1, 2, 3, 4), (1, 2, "3"), (1, 2, None), 7, (1, 2, 1j), (10**400, 0, 0))


@pytest.mark.parametrize("values", NO_NUMBERS)
def test_what_are_no_numbers_is_refused(values: object) -> None:
    with pytest.raises(KinematicsError) as caught:
        reals(values, 3, "axes")  # type: ignore[arg-type]
    assert caught.value.status is Status.BAD_INPUT
    assert "axes must be 3 numbers" in str(caught.value)


@pytest.mark.parametrize(
    "values", [(1, 2, 3), [1.0, 2.0, 3.0], np.array([1, 2, 3]), iter((1, 2, 3)), (np.float32(1), 2, 3)]
)
def test_any_sequence_of_numbers_is_taken(values: object) -> None:
    found = reals(values, 3, "axes")  # type: ignore[arg-type]
    assert found == (1.0, 2.0, 3.0) and all(type(v) is float for v in found)


@pytest.mark.parametrize("bytes_", ["12", (1.0, 0), (1,), (1, 0, 0), (1, 256), (1, -129), (1, 10**9), None])
def test_what_are_no_bytes_is_refused(bytes_: object) -> None:
    with pytest.raises(KinematicsError) as caught:
        bytes_of(bytes_, 2)  # type: ignore[arg-type]
    assert caught.value.status is Status.BAD_INPUT


@pytest.mark.parametrize("rows", [np.eye(4), ((1, 0, 0), (0, 1, 0)), "abc", 1.0, ((1, 0), (0, 1), (0, 0))])
def test_what_are_no_three_rows_is_refused(rows: object) -> None:
    with pytest.raises(KinematicsError):
        rotation_by_rows(rows)  # type: ignore[arg-type]


def test_rows_of_arrays() -> None:
    assert numbers(np.empty((0, 3)), None, (3,), "positions").shape == (0, 3)
    assert numbers((1, 2, 3), 5, (3,), "references").shape == (5, 3)
    for wrong in ([1, 2, 3], [["a", "b", "c"]], [[1, 2], [3]], [[math.nan] * 4], [[None] * 3]):
        with pytest.raises(KinematicsError) as caught:
            numbers(wrong, None, (3,), "positions")  # type: ignore[arg-type]
        assert caught.value.status is Status.BAD_INPUT and "positions" in str(caught.value)
    with pytest.raises(KinematicsError):
        numbers(np.zeros((4, 3)), 5, (3,), "references")
    with pytest.raises(KinematicsError):
        whole_numbers([[1.0, 0.0]], 1, 2, "configurations")
