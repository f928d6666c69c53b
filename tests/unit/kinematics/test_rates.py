"""Forward-mode differentiation of statements, against differences of what they compute."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

from derive.ir.interpret import Array, run
from derive.ir.passes import normalise
from derive.ir.primitives import Atan2, Root, Select, Wrap
from derive.ir.program import Iterate, Let, Output, Solve, Statement
from derive.ir.symbols import Names, flag, real
from derive.ir.verify import BrokenProgram
from derive.kinematics.rates import Rates

T, A, B, C, M, N = map(real, ("time", "first", "second", "third", "one", "other"))
SPEED = real("speed")
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
    """What a name is bound to is not differentiated where its rate is given."""
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
