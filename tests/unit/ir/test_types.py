"""The types of values, and systems that have no solution: in every language, and nothing faults."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from softkin import _array, _scalar

from derive.emit.python.printer import ScalarPrinter
from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root, Select, ToReal, Wrap, solve
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Solve, Statement, Status
from derive.ir.symbols import Flag, called, count, flag, real
from derive.ir.types import IllTypedError, Type, type_of
from derive.ir.verify import BrokenProgram, verify
from tests.unit.ir.test_loops import controller

A, B, N, M, X, Y = flag("a"), flag("b"), count("n"), count("m"), real("x"), real("y")


@pytest.mark.parametrize(
    "value, expected",
    [
        (A, Type.BOOL), (sp.And(A, X > 0), Type.BOOL), (sp.Not(A), Type.BOOL), (sp.Eq(N, 3), Type.BOOL),
        (sp.Ne(N, M), Type.BOOL),
        (N > 0, Type.BOOL), (sp.true, Type.BOOL), (N, Type.INT), (2 * N - 1, Type.INT), (N * M, Type.INT),
        (Select(N > 0, N - 1, N), Type.INT), (ToReal(N) * X, Type.REAL), (X, Type.REAL), (X / 2 + 1, Type.REAL),
        (Select(A, X, 0), Type.REAL), (Root(X), Type.REAL), (sp.Float("0.5"), Type.REAL), (sp.Integer(3), Type.WRITTEN),
        (Select(A, 1, -1), Type.WRITTEN),
    ],
)  # fmt: skip
def test_every_expression_has_a_type(value: sp.Basic, expected: Type) -> None:
    assert type_of(value) is expected


@pytest.mark.parametrize(
    "value",
    [
        A + X, A * X, N * X, N + X, N + sp.Rational(1, 2), X > N, sp.Eq(X, Y), sp.Ne(X, 0), Select(X, X, Y),
        Select(A, N, X),
        Select(A, A, B), sp.And(A, N), Root(N), Root(A), sp.sin(N), ToReal(X), ToReal(A), 1 / N, sp.Abs(A), Atan2(N, X),
        sp.Not(sp.And(X > 0, Y > 0)), NearestPeriod(X, N), A > 0, sp.tan(X),
    ],
)  # fmt: skip
def test_mixtures_are_refused(value: sp.Basic) -> None:
    with pytest.raises(IllTypedError):
        type_of(value)


def _program(*body: Statement, outputs: tuple[Output, ...] = ()) -> Program:
    return Program("p", (A, B, N, M, X, Y), body, outputs)


def _loop(**changed: object) -> Iterate:
    parts: dict[str, object] = {
        "state": (real("s"), flag("f"), count("k")), "start": (X, sp.false, sp.Integer(0)), "step": (),
        "following": (real("s") / 2, X > 0, count("k") + 1), "done": flag("f"), "limit": 3,
        "otherwise": Status.UNREACHABLE,
    }  # fmt: skip
    return Iterate(**(parts | changed))  # type: ignore[arg-type]


SHARED = Program("shared", (A, N, X), (), (Output("is_far", X > 1), Output("twice", 2 * X), Output("next", N + 1)))
NAMES = (flag("is_far"), real("twice"), count("next"))


@pytest.mark.parametrize(
    "statement",
    [
        Let(flag("f"), X > 0), Let(count("k"), sp.Integer(2)), Let(real("v"), sp.Integer(2)),
        Require(A, Status.BAD_INPUT),
        Solve((real("v"),), (X,), (Y,)), _loop(), Call(SHARED, ((A, X > 0), (N, M), (X, Y)), NAMES),
    ],
)  # fmt: skip
def test_values_of_the_type_of_their_names_pass(statement: Statement) -> None:
    verify(_program(statement))


@pytest.mark.parametrize(
    "statement",
    [
        Let(real("v"), X > 0), Let(flag("f"), X), Let(flag("f"), sp.Integer(1)), Let(count("k"), X), Let(real("v"), N),
        Let(count("k"), sp.Rational(1, 2)), Require(X, Status.BAD_INPUT), Require(N, Status.BAD_INPUT),
        Solve((real("v"),), (ToReal(N) + N,), (Y,)), Solve((real("v"),), (N,), (Y,)),
        _loop(start=(X, sp.Integer(0), sp.Integer(0))), _loop(start=(X, sp.false, X)),
        _loop(following=(real("s"), X, count("k"))), _loop(done=real("s")),
        Call(SHARED, ((A, X), (N, M), (X, Y)), NAMES), Call(SHARED, ((A, A), (N, X), (X, Y)), NAMES),
        Call(SHARED, ((A, A), (N, M), (X, Y)), (real("is_far"),)),
        Call(SHARED, ((A, A), (N, M), (X, Y)), (real("next"),)),
    ],
)  # fmt: skip
def test_values_of_another_type_are_refused(statement: Statement) -> None:
    with pytest.raises(BrokenProgram):
        verify(_program(statement))


def test_a_name_that_is_read_as_another_type_is_refused() -> None:
    with pytest.raises(BrokenProgram, match="another type"):
        verify(_program(Let(flag("f"), X > 0), Let(real("v"), real("f") + 1)))
    with pytest.raises(BrokenProgram, match="mixes types"):
        verify(_program(outputs=(Output("o", N * X),)))


def test_normalising_keeps_types_and_drops_what_else_is_known() -> None:
    length = sp.Symbol("length", positive=True)
    program = normalise(
        "p", [Let(A, length > 1), Let(X, Select(A, ToReal(N), length))], [Output("o", X), Output("n", N)]
    )
    assert [type(s) for s in program.bound()] == [Flag, sp.Symbol]
    assert set(program.inputs) == {N, real("length")}
    assert [called("other", like) for like in (A, N, length)] == [flag("other"), count("other"), real("other")]


def test_programs_run_in_their_types() -> None:
    outputs = [Output("f", A), Output("k", N + 1), Output("v", Select(A, ToReal(N) / 2, X))]
    values, _ = run(
        _program(outputs=tuple(outputs)), {"a": [0, 1], "b": 0, "n": [3.0, 4.0], "m": 0, "x": 0.25, "y": 0.0}
    )  # type: ignore[dict-item]
    assert values["f"].dtype == bool and values["f"].tolist() == [False, True]
    assert values["k"].tolist() == [4, 5] and np.allclose(values["v"], [0.25, 2.0])


Q, R, DIRECTION = real("q"), real("r"), Atan2(Y, X)
ANGLES = {Q: Type.ANGLE, R: Type.ANGLE, real("h"): Type.HEADING}


@pytest.mark.parametrize(
    "value, expected",
    [
        (DIRECTION, Type.ANGLE), (Q + R, Type.ANGLE), (Q - 2 * R, Type.ANGLE), (Q + X, Type.ANGLE),
        (180 * DEGREE - Q, Type.ANGLE), (Select(X > 0, Q, DIRECTION), Type.ANGLE), (Select(X > 0, Q, 0), Type.ANGLE),
        (sp.sin(Q + R), Type.REAL), (sp.cos(X), Type.REAL),
        (NearestOnArc(Q, R + X, Y), Type.ANGLE), (Wrap(Q - R), Type.REAL), (Wrap(X), Type.REAL),
        (Q / DEGREE, Type.HEADING),
        ((Q + R) / DEGREE + X, Type.HEADING), (2 * X - real("h"), Type.HEADING),
        (NearestPeriod(Q / DEGREE + X, Y), Type.REAL),
        (NearestPeriod(real("h"), Y), Type.REAL), (NearestPeriod(X, Y) * Y, Type.REAL),
        (Wrap(DIRECTION) * X, Type.REAL),
    ],
)  # fmt: skip
def test_angles_are_added_and_asked_for_sines(value: sp.Basic, expected: Type) -> None:
    assert type_of(value, ANGLES) is expected


@pytest.mark.parametrize(
    "value",
    [
        X * Q, Q / 2, Q * R, Q**2, Q * DEGREE, Root(Q), sp.Abs(Q), Q > 0, sp.And(X > 0, Q < R), Atan2(Q, X),
        Q / DEGREE + R,
        NearestPeriod(Q, X), NearestPeriod(Q / DEGREE, R), NearestPeriod(X, Q / DEGREE), NearestOnArc(X, Y, Q),
        ToReal(Q),
        sp.sin(Q / DEGREE), X * real("h"), real("h") * DEGREE, Select(Q > 0, X, Y), Q + N, Wrap(real("h")),
        X * DIRECTION,
    ],
)  # fmt: skip
def test_an_angle_is_no_number_before_its_turn_is_chosen(value: sp.Basic) -> None:
    with pytest.raises(IllTypedError):
        type_of(value, ANGLES)


@pytest.mark.parametrize(
    "statement",
    [
        Let(real("travel"), Q * X), Require(Q > 0, Status.UNREACHABLE), Solve((real("v"),), (X,), (Q,)),
        Call(SHARED, ((A, A), (N, N), (X, Q)), ()),
        _loop(start=(X, sp.false, sp.Integer(0)), following=(Q, X > 0, count("k"))),
        _loop(start=(Q, sp.false, sp.Integer(0)), following=(real("s") * X, X > 0, count("k"))),
    ],
)  # fmt: skip
def test_a_name_that_is_bound_to_an_angle_is_one(statement: Statement) -> None:
    angle = Let(Q, DIRECTION)
    with pytest.raises(BrokenProgram):
        verify(_program(angle, statement))
    verify(_program(replace(angle, value=Wrap(DIRECTION)), statement))


def test_a_loop_may_turn_and_a_call_answers_with_angles() -> None:
    turning = _loop(start=(DIRECTION, sp.false, sp.Integer(0)), following=(real("s") + X, X > 0, count("k")))
    verify(_program(turning, Let(real("c"), sp.cos(real("s")))))
    told = Program("told", (X, Y), (), (Output("angle", DIRECTION),))
    call = Call(told, (), (real("angle"),))
    verify(_program(call, Let(real("c"), sp.cos(real("angle")))))
    with pytest.raises(BrokenProgram):
        verify(_program(call, Let(real("c"), X * real("angle"))))


def test_wrap_is_the_angle_of_a_direction() -> None:
    angles = np.array([-3.5 * np.pi, -np.pi, -3.0, -1e-9, 0.0, 1.0, np.pi, np.pi + 0.5, 9.0, 40.0])
    values, _ = run(
        _program(outputs=(Output("w", Wrap(X)),)), {n: angles if n == "x" else np.zeros(10) for n in "abnmxy"}
    )
    assert np.all((values["w"] > -np.pi) & (values["w"] <= np.pi))
    np.testing.assert_allclose(np.exp(1j * values["w"]), np.exp(1j * angles), atol=1e-14)
    assert values["w"][6] == np.pi and values["w"][1] == np.pi
    text = ScalarPrinter().print(Wrap(X))
    assert (
        text == "arctan2(sin(x) + 0.0, cos(x) + 0.0)"
        and ScalarPrinter().print(Wrap(DIRECTION)) == "arctan2(y + 0.0, x + 0.0)"
    )


Array = NDArray[np.float64]
REGULAR = np.array([[2.0, 1.0, 0.0], [1.0, -3.0, 1.0], [0.0, 1.0, 4.0]])
SIDES = np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])
NO_NUMBERS = [np.nan, np.inf, -np.inf, 1e31, -1e31, 1.7e308]


def answers(matrix: Array, right: Array) -> list[tuple[float, list[float]]]:
    """Determinant and solution: the reference, of one system and of many, both runtimes of Python, and Structured Text,
    which faults where a PLC would.
    """
    rows, sides = matrix.tolist(), right.tolist()
    with np.errstate(all="ignore"):
        references = [solve(*(np.repeat(t[..., None], count, axis=2) for t in (matrix, right))) for count in (1, 20)]
        batch = _array.solve(*([tuple(np.array([v]) for v in row) for row in table] for table in (rows, sides)))
    scalar = _scalar.solve(rows, sides)
    return [
        *((float(d[0]), solution[..., 0].ravel().tolist()) for d, solution in references),
        (float(batch[0][0]), [float(v[0]) for v in batch[1:]]),
        (scalar[0], list(scalar[1:])),
        controller(rows, sides),
    ]


def assert_nothing(matrix: Array, right: Array = SIDES) -> None:
    assert answers(matrix, right) == [(0.0, [0.0] * right.size)] * 5


@pytest.mark.parametrize("wrong", NO_NUMBERS)
def test_an_entry_that_is_no_number(wrong: float) -> None:
    """A system with an entry that is no number has no solution, in every language."""
    for place in np.ndindex(3, 3):
        matrix = REGULAR.copy()
        matrix[place] = wrong
        assert_nothing(matrix)


@pytest.mark.parametrize("wrong", NO_NUMBERS)
def test_a_right_hand_side_that_is_no_number(wrong: float) -> None:
    for place in np.ndindex(3, 2):
        right = SIDES.copy()
        right[place] = wrong
        assert_nothing(REGULAR, right)


def test_a_pivot_that_is_zero_in_every_step() -> None:
    """A singular system of any rank has no solution, in every language."""
    for rank in (0, 1, 2):
        kept = np.arange(3) < rank
        assert_nothing(REGULAR * kept)
        assert_nothing(REGULAR * kept[:, None])
    assert_nothing(np.full((3, 3), np.nan), np.full((3, 2), np.nan))


def test_the_sizes_of_numbers_that_are_solved() -> None:
    wanted = np.linalg.solve(REGULAR, SIDES)
    for size in (3e-31, 2e29):
        for determinant, solution in answers(REGULAR * size, SIDES):
            assert determinant != 0.0
            np.testing.assert_allclose(np.reshape(solution, (3, 2)) * size, wanted, rtol=1e-12)
    assert_nothing(REGULAR * 2e-31)


@given(st.integers(0, 2**32 - 1), st.integers(1, 6))
def test_the_worst_that_is_solved_stays_finite(seed: int, size: int) -> None:
    """Numbers of any size next to each other, all but singular: no product overflows, and the languages agree."""
    generator = np.random.default_rng(seed)
    exponents = generator.choice([-30, -16, -14, -8, 0, 14, 30], (2, size, size))
    matrix, right = generator.choice([-1.0, 1.0, 0.999999999999], (2, size, size)) * 10.0**exponents
    found = answers(matrix, right)
    assert np.isfinite(found[0][0]) and np.isfinite(found[0][1]).all()
    assert found == [found[0]] * 5
