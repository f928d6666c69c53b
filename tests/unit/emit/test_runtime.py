"""The primitives of the generated package, on plain numbers and on arrays, against the reference semantics."""

import math
from collections.abc import Callable

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from softkin import _array, _scalar
from softkin._types import Status

from derive.ir.interpret import evaluate
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root
from derive.ir.symbols import real

SIZES = st.floats(-1e9, 1e9) | st.sampled_from([0.0, -0.0, 1.0, -1.0, 1e-12, -1e-12, 180.0, -180.0])
ANGLES = st.floats(-50.0, 50.0)
DEGREES = st.floats(-1e5, 1e5) | st.integers(-20, 20).map(lambda n: 180.0 * n)
PRIMITIVES: dict[str, tuple[type[sp.Function], tuple[st.SearchStrategy[float], ...]]] = {
    "sin": (sp.sin, (ANGLES,)),
    "cos": (sp.cos, (ANGLES,)),
    "root": (Root, (SIZES,)),
    "atan2": (Atan2, (SIZES, SIZES)),
    "nearest_period": (NearestPeriod, (DEGREES, DEGREES)),
    "nearest_on_arc": (NearestOnArc, (ANGLES, ANGLES, st.floats(0.0, math.pi))),
}


@pytest.mark.parametrize("name", PRIMITIVES)
@given(data=st.data())
def test_primitive_is_its_reference(name: str, data: st.DataObject) -> None:
    function, ranges = PRIMITIVES[name]
    arguments = [data.draw(r) for r in ranges]
    symbols = [real(f"argument_{i}") for i, _ in enumerate(arguments)]
    values = {s.name: np.asarray(v) for s, v in zip(symbols, arguments, strict=True)}
    expected = float(evaluate(function(*symbols), values))
    scalar: Callable[..., float] = getattr(_scalar, name)
    array: Callable[..., np.ndarray] = getattr(_array, name)
    assert scalar(*arguments) == pytest.approx(expected, rel=1e-15, abs=1e-15)
    assert array(*(np.array([v]) for v in arguments))[0] == pytest.approx(expected, rel=1e-15, abs=1e-15)


def test_select_and_absolute() -> None:
    values = np.array([-1.0, 2.0])
    assert list(_array.select(values > 0.0, values, 7.0)) == [7.0, 2.0]
    assert list(_array.absolute(values)) == [1.0, 2.0]


def test_a_row_keeps_its_first_failure_and_nan_is_one() -> None:
    values = np.array([0.0, 1.0, 5.0, math.nan])
    status = _array.passed((values,))
    _array.require(status, values <= 2.0, Status.UNREACHABLE)
    _array.require(status, values <= 0.5, Status.IMPOSSIBLE)
    assert list(status) == [Status.OK, Status.IMPOSSIBLE, Status.UNREACHABLE, Status.UNREACHABLE]


def test_elsewhere_computes_in_the_other_rows_alone() -> None:
    values, asked = np.array([1.0, 2.0, 3.0]), []

    def other(given: np.ndarray, number: float) -> tuple[np.ndarray, float]:
        asked.append((given, number))
        return given + number, 7.0

    found = _array.elsewhere(values < 1.5, (values, 5.0), other, (values, 10.0))
    assert [list(v) for v in found] == [[1.0, 12.0, 13.0], [5.0, 7.0, 7.0]]
    assert list(asked[0][0]) == [2.0, 3.0] and list(values) == [1.0, 2.0, 3.0]
    assert _array.elsewhere(values > 0.0, (values, 5.0), other, (values, 10.0))[0] is values and len(asked) == 1
    assert _array.elsewhere(False, (1.0, 5.0), other, (2.0, 10.0)) == (12.0, 7.0)  # type: ignore[arg-type]


def test_a_choice_that_all_rows_share_copies_nothing() -> None:
    values = np.array([1.0, 2.0])
    assert _array.select(values > 0.0, values, 7.0) is values
    assert _array.select(False, values, 7.0) == 7.0
    assert _array.nearest_period(values, 0.0) is values
    assert list(_array.nearest_period(np.array([1.0, math.nan, 361.0]), 0.0))[::2] == [1.0, 1.0]


SHAPES = ((), (3,), (2, 1), (2, 3), (2, 1, 1), (2, 1, 3), (2, 2, 1), (2, 2, 3))
"""Of values that depend on rows, on the sign of a first branch, on that of a second one, or on some of them."""


def drawn(data: st.DataObject, name: str) -> np.ndarray | float:
    """A value of one of these shapes."""
    shape = data.draw(st.sampled_from(SHAPES), name)
    values = np.array(data.draw(st.lists(st.integers(-9, 9), min_size=12, max_size=12), name), float)
    return values[: math.prod(shape)].reshape(shape) if shape else float(values[0])


def test_statuses_are_there_for_all_that_is_given_together() -> None:
    column, sign, other = np.zeros(3), np.array([[1], [-1]]), np.array([[[1]], [[-1]]])
    assert _array.passed((column, 1.0, column)).shape == (3,)
    assert _array.passed((column, 1.0), (), (sign, 1)).shape == (2, 3)
    assert _array.passed((1.0, 2.0), ((column, 1.0), (other, 1.0)), (sign,)).shape == (2, 2, 3)
    assert _array.passed((1.0,), ()).shape == ()


@given(st.data())
def test_every_slot_of_a_row_keeps_its_first_failure(data: st.DataObject) -> None:
    status, expected = np.zeros((2, 2, 3), np.uint8), np.zeros((2, 2, 3), np.uint8)
    for otherwise in (Status.UNREACHABLE, Status.IMPOSSIBLE, Status.UNREACHABLE):
        condition = np.asarray(drawn(data, otherwise.name) > np.asarray(-4.0))
        _array.require(status, condition if condition.ndim else bool(condition), otherwise)
        for at in np.ndindex(expected.shape):
            if not np.broadcast_to(condition, expected.shape)[at] and expected[at] == Status.OK:
                expected[at] = otherwise
    assert (status == expected).all()


def test_numbers_of_reasonable_size() -> None:
    rows, slots = np.array([1e9, -1e9, 1.1e9, math.nan, -math.inf]), np.array([[0.0], [-2e9]])
    assert _array.reasonable(rows[:2], 5.0, np.zeros((2, 1))) is True
    assert np.asarray(_array.reasonable(rows, 5.0)).tolist() == [True, True, False, False, False]
    assert np.asarray(_array.reasonable(rows[:2], slots)).tolist() == [[True], [False]]
    assert np.asarray(_array.reasonable(rows, slots)).tolist() == [[True, True, False, False, False], [False] * 5]
    assert not any(_array.reasonable(wrong) for wrong in (1.1e9, math.nan, -math.inf))


@given(st.data())
def test_values_of_any_shapes_are_chosen_together(data: st.DataObject) -> None:
    level, first, second, a, b = (drawn(data, name) for name in ("level", "first", "second", "a", "b"))
    condition = np.greater(level, -3.0) if isinstance(level, np.ndarray) else level > -3.0

    def other(a: np.ndarray, b: np.ndarray, number: float) -> tuple[np.ndarray | float, ...]:
        assert np.ndim(a) <= 1 and np.ndim(b) <= 1 or condition is False
        return a - 3.0 * b, number

    found = _array.elsewhere(condition, (first, second), other, (a, b, 7.0))
    shape = (2, 2, 3)
    whole = [np.broadcast_to(v, shape) for v in (condition, first, second, a, b)]
    expected = np.where(whole[0], whole[1], whole[3] - 3.0 * whole[4]), np.where(whole[0], whole[2], 7.0)
    for one, right in zip(found, expected, strict=True):
        assert (np.broadcast_to(one, shape) == right).all()
    assert (np.broadcast_to(_array.select(condition, first, second), shape) == np.where(*whole[:3])).all()


@given(st.data())
def test_systems_of_any_shapes_are_solved_together(data: st.DataObject) -> None:
    entries = [drawn(data, name) for name in ("m11", "m12", "m21", "m22", "right")]
    m11, m12, m21, m22, right = entries
    determinant, x, y = _array.solve(((m11, m12), (m21, m22)), ((right,), (1.0,)))
    shape = np.broadcast_shapes(*map(np.shape, entries))
    assert determinant.shape == x.shape == y.shape == shape
    for at in np.ndindex(shape):
        a, b, c, d, e = (float(np.broadcast_to(v, shape)[at]) for v in entries)
        assert determinant[at] == pytest.approx(a * d - b * c, abs=1e-9)
        if a * d != b * c:
            assert (a * x[at] + b * y[at], c * x[at] + d * y[at]) == pytest.approx((e, 1.0), abs=1e-9)


def test_slots_that_are_done_keep_their_state() -> None:
    done, status = np.array([[True], [False]]), np.zeros((2, 3), np.uint8)
    assert not _array.settled(done, status)
    state = _array.advanced(done, (1.0, np.array([1.0, 2.0, 3.0])), (np.array([5.0, 6.0, 7.0]), 8.0))
    assert state[0].tolist() == [[1.0, 1.0, 1.0], [5.0, 6.0, 7.0]] and state[1].tolist() == [[1.0, 2.0, 3.0], [8.0] * 3]
    status[1] = Status.IMPOSSIBLE
    assert _array.settled(done, status)


@given(value=DEGREES, centre=DEGREES)
def test_turns_are_chosen_by_slot_and_row(value: float, centre: float) -> None:
    values, centres = np.array([[value], [value + 400.0]]), np.array([centre, centre - 800.0, 0.0])
    found = _array.nearest_period(values, centres)
    right = [[_scalar.nearest_period(v, c) for c in centres.tolist()] for v in values[:, 0].tolist()]
    assert found.tolist() == right
