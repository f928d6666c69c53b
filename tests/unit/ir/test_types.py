"""Types: what an expression is, and which mixtures are refused."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

from derive.ir.interpret import run
from derive.ir.passes import assemble
from derive.ir.primitives import Atan2, NearestPeriod, Root, Select, ToReal
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Solve, Statement, Status
from derive.ir.symbols import Flag, called, count, flag, real
from derive.ir.types import IllTypedError, Type, type_of
from derive.ir.verify import BrokenProgram, verify

A, B, N, M, X, Y = flag("a"), flag("b"), count("n"), count("m"), real("x"), real("y")


@pytest.mark.parametrize(
    "value, expected",
    [
        (A, Type.BOOL), (sp.And(A, X > 0), Type.BOOL), (sp.Not(A), Type.BOOL), (sp.Eq(N, 3), Type.BOOL), (sp.Ne(N, M), Type.BOOL),
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
        A + X, A * X, N * X, N + X, N + sp.Rational(1, 2), X > N, sp.Eq(X, Y), sp.Ne(X, 0), Select(X, X, Y), Select(A, N, X),
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
        "following": (real("s") / 2, X > 0, count("k") + 1), "done": flag("f"), "limit": 3, "otherwise": Status.UNREACHABLE,
    }  # fmt: skip
    return Iterate(**(parts | changed))  # type: ignore[arg-type]


SHARED = Program("shared", (A, N, X), (), (Output("is_far", X > 1), Output("twice", 2 * X), Output("next", N + 1)))
NAMES = (flag("is_far"), real("twice"), count("next"))


@pytest.mark.parametrize(
    "statement",
    [
        Let(flag("f"), X > 0), Let(count("k"), sp.Integer(2)), Let(real("v"), sp.Integer(2)), Require(A, Status.BAD_INPUT),
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
        Call(SHARED, ((A, A), (N, M), (X, Y)), (real("is_far"),)), Call(SHARED, ((A, A), (N, M), (X, Y)), (real("next"),)),
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


def test_assembling_keeps_types_and_drops_what_else_is_known() -> None:
    length = sp.Symbol("length", positive=True)
    program = assemble("p", [Let(A, length > 1), Let(X, Select(A, ToReal(N), length))], [Output("o", X), Output("n", N)])
    assert [type(s) for s in program.bound()] == [Flag, sp.Symbol]
    assert set(program.inputs) == {N, real("length")}
    assert called("other", A) == flag("other") and called("other", N) == count("other")
    assert called("other", length) == real("other")


def test_programs_run_in_their_types() -> None:
    outputs = [Output("f", A), Output("k", N + 1), Output("v", Select(A, ToReal(N) / 2, X))]
    values, _ = run(_program(outputs=tuple(outputs)), {"a": [0, 1], "b": 0, "n": [3.0, 4.0], "m": 0, "x": 0.25, "y": 0.0})  # type: ignore[dict-item]
    assert values["f"].dtype == bool and values["f"].tolist() == [False, True]
    assert values["k"].tolist() == [4, 5] and np.allclose(values["v"], [0.25, 2.0])
