"""The verifier refuses every program that some language could not print, and names program and place."""

import re

import pytest
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root, Select
from derive.ir.program import Let, Output, Program, Require, Statement, Status
from derive.ir.symbols import real
from derive.ir.verify import BrokenProgram, verify

X, Y, Z = (real(n) for n in "xyz")


def program(*body: Statement, inputs: tuple[sp.Symbol, ...] = (X, Y), output: sp.Expr = X) -> Program:
    return Program("sample", inputs, body, (Output("result", output),))


def test_every_primitive_is_accepted() -> None:
    """A program with every primitive is accepted."""
    far = sp.And(sp.Gt(X, 0), sp.Or(sp.Le(Y, 1), sp.Lt(X, Y)), sp.Ge(Y, -1))
    sample = program(
        Let(Z, sp.sin(X) + sp.cos(Y) * sp.Abs(X) - Root(X**2) / Y + X**-2 + sp.Rational(1, 3) + sp.Float(0.5)),
        Require(far, Status.UNREACHABLE),
        Let(real("turn"), NearestPeriod(Atan2(Y, X) / DEGREE, Z)),
        Let(real("on_arc"), NearestOnArc(X, Y, 90 * DEGREE)),
        Let(real("choice"), Select(far, X, Select(sp.true, Y, Z))),
        output=real("choice"),
    )
    assert verify(sample) is sample


BROKEN = {
    "a name that nothing binds": (program(Let(Z, X + real("w"))), "'w' is read before it is bound"),
    "a name that is bound later": (program(Let(Z, real("w")), Let(real("w"), X)), "'w' is read before it is bound"),
    "a name that binds itself": (program(Let(Z, Z + 1)), "'z' is read before it is bound"),
    "an unbound condition": (program(Require(sp.Gt(Z, 0), Status.UNREACHABLE)), "'z' is read before it is bound"),
    "an unbound output": (program(output=Z), "'z' is read before it is bound"),
    "an unbound name in a choice": (program(Let(Z, Select(sp.Gt(real("w"), 0), X, Y))), "'w' is read before"),
    "a name twice": (program(Let(Z, X), Let(Z, Y)), "'z' is bound twice"),
    "an input bound again": (program(Let(X, Y)), "'x' is bound twice"),
    "one name in two spellings": (
        program(Let(real("cos_a12"), X), Let(real("cos_a_12"), Y)),
        "'cos_a_12' is bound twice (also as 'cos_a12')",
    ),
    "two inputs of one spelling": (program(inputs=(X, real("a_1"), real("a1"))), "'a1' is bound twice (also as 'a_1')"),
    "an upper case letter": (program(Let(real("Z"), X)), "'Z' is not a portable"),
    "a leading digit": (program(Let(real("2z"), X)), "'2z' is not a portable"),
    "a leading underscore": (program(Let(real("_z"), X)), "'_z' is not a portable"),
    "a trailing underscore": (program(Let(real("z_"), X)), "'z_' is not a portable"),
    "a double underscore": (program(Let(real("z__a"), X)), "'z__a' is not a portable"),
    "a blank": (program(Let(real("z a"), X)), "'z a' is not a portable"),
    "a letter of another alphabet": (program(Let(real("φ"), X)), "'φ' is not a portable"),
    "no name": (program(Let(real(""), X)), "'' is not a portable"),
    "a square root": (program(Let(Z, sp.sqrt(X))), "is not an integer power"),
    "a surd": (program(Let(Z, X * sp.sqrt(3))), "power sqrt(3) is not an integer power"),
    "a real exponent": (program(Let(Z, X ** sp.Float(2.5))), "is not an integer power"),
    "a variable exponent": (program(Let(Z, X**Y)), "is not an integer power"),
    "an exponential": (program(Let(Z, sp.exp(X))), "exp is not a primitive"),
    "a tangent": (program(Let(Z, sp.tan(X))), "tan is not a primitive"),
    "an arc cosine": (program(Let(Z, sp.acos(X))), "acos is not a primitive"),
    "SymPy's own arc tangent": (program(Let(Z, sp.atan2(X, Y))), "atan2 is not a primitive"),
    "a maximum": (program(Let(Z, sp.Max(X, Y))), "Max is not a primitive"),
    "a case distinction": (program(Let(Z, sp.Piecewise((X, X > 0), (Y, True)))), "Piecewise is not a primitive"),
    "pi": (program(Let(Z, sp.pi * X)), "Pi is not a primitive"),
    "an infinity": (program(Let(Z, sp.oo * sp.Abs(X), "")), "is not a primitive"),
    "not a number": (program(Let(Z, sp.nan)), "NaN is not a primitive"),
    "an imaginary number": (program(Let(Z, sp.I * X)), "ImaginaryUnit is not a primitive"),
    "an equation": (program(Require(sp.Eq(X, Y), Status.UNREACHABLE)), "Eq(x, y) mixes types"),
    "an inequation": (program(Require(sp.Ne(X, Y), Status.UNREACHABLE)), "Ne(x, y) mixes types"),
    "a negation": (program(Require(sp.Not(sp.And(X > 0, sp.Eq(Y, 1), evaluate=False)), Status.OK)), "mixes types"),
    "the opposite of a condition": (
        program(Require(sp.Not(sp.And(X > 0, Y > 1)), Status.OK)),
        "is not the opposite of a flag",
    ),
}


@pytest.mark.parametrize("kind", BROKEN)
def test_broken_programs_are_refused(kind: str) -> None:
    """A broken program is refused with the message for its fault."""
    broken, message = BROKEN[kind]
    with pytest.raises(BrokenProgram, match="^sample: .*" + re.escape(message)):
        verify(broken)
