"""Execute a program with any number of digits: the values of its formulas without the rounding of doubles."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache

import mpmath
import sympy as sp

from derive.ir.constants import (
    DEGREE,
    EDGE,
)
from derive.ir.primitives import (
    Atan2,
    NearestOnArc,
    NearestPeriod,
    Root,
    Select,
    ToReal,
    Wrap,
)
from derive.ir.program import (
    Let,
    Program,
    Require,
    Status,
)

DIGITS = 60
Number = mpmath.mpf


def _nearest_period(value: Number, centre: Number) -> Number:
    return value - 360 * mpmath.floor((value - centre + 180 + Number(float(EDGE))) / 360)


def _nearest_on_arc(angle: Number, centre: Number, half: Number) -> Number:
    turn = 2 * mpmath.pi
    delta = angle - centre - turn * mpmath.floor((angle - centre + mpmath.pi) / turn)
    return centre + min(max(delta, -half), half)


_FUNCTIONS: dict[type[sp.Basic], Callable[..., object]] = {
    sp.sin: mpmath.sin,
    sp.cos: mpmath.cos,
    sp.Abs: abs,
    Root: lambda x: mpmath.sqrt(max(x, Number(0))),
    Atan2: lambda y, x: mpmath.atan2(y, x) if x or y else Number(0),
    Select: lambda condition, first, second: first if condition else second,
    NearestPeriod: _nearest_period,
    NearestOnArc: _nearest_on_arc,
    sp.Le: lambda a, b: a <= b,
    sp.Lt: lambda a, b: a < b,
    sp.Ge: lambda a, b: a >= b,
    sp.Gt: lambda a, b: a > b,
    sp.Eq: lambda a, b: a == b,
    sp.Ne: lambda a, b: a != b,
    sp.Not: lambda c: not c,
    ToReal: lambda n: n,
    Wrap: lambda angle: angle - 2 * mpmath.pi * mpmath.ceil(angle / (2 * mpmath.pi) - Number(1) / 2),
    sp.And: lambda *c: all(c),
    sp.Or: lambda *c: any(c),
    sp.Add: lambda *t: sum(t, Number(0)),
    sp.Mul: lambda *t: mpmath.fprod(t),
    sp.Pow: lambda b, e: b ** int(e),
}
_NAME, _NUMBER = "a name", "a number"


@cache
def _code(expression: sp.Basic) -> tuple[object, ...]:
    """The expression as nested tuples, which are walked faster than SymPy's trees; its numbers have all digits."""
    with mpmath.workdps(DIGITS):
        return _read(expression)


def _read(expression: sp.Basic) -> tuple[object, ...]:
    if expression == sp.pi:
        return (_NUMBER, +mpmath.pi)
    if isinstance(expression, sp.Pow) and not expression.exp.is_Integer:
        return (mpmath.power, _code(expression.base), _code(expression.exp))
    if isinstance(expression, sp.Symbol):
        return (_NUMBER, mpmath.pi / 180) if expression == DEGREE else (_NAME, expression.name)
    if expression in (sp.true, sp.false):
        return (_NUMBER, expression == sp.true)
    if isinstance(expression, sp.Rational):
        return (_NUMBER, Number(int(expression.p)) / int(expression.q))
    if isinstance(expression, sp.Number):
        return (
            _NUMBER,
            Number(float(expression)),
        )  # a constant of the product is the double that stands in every language
    return (_FUNCTIONS[type(expression)], *(_code(a) for a in expression.args))


def _value(code: tuple[object, ...], values: Mapping[str, object]) -> object:
    head = code[0]
    if head is _NAME:
        return values[code[1]]  # type: ignore[index]
    if head is _NUMBER:
        return code[1]
    return head(*[_value(argument, values) for argument in code[1:]])  # type: ignore[arg-type, operator]


def run_exactly(program: Program, values: Mapping[str, Number]) -> tuple[dict[str, Number], Status]:
    """Outputs and status of one call. Straight-line programs alone: no loop, no system of equations."""
    with mpmath.workdps(DIGITS):
        known: dict[str, object] = dict(values)
        status = Status.OK
        for statement in program.body:
            if isinstance(statement, Let):
                known[statement.name.name] = _value(_code(statement.value), known)
            elif isinstance(statement, Require):
                holds = _value(_code(statement.condition), known)
                status = statement.otherwise if status is Status.OK and not holds else status
            else:
                raise TypeError(f"{type(statement).__name__} is no statement of a straight line")
        return {o.name: _value(_code(o.value), known) for o in program.outputs}, status  # type: ignore[misc]


def evaluate_exactly(expression: sp.Basic, values: Mapping[str, Number]) -> Number:
    """An expression of a description, its symbols by their names."""
    with mpmath.workdps(DIGITS):
        return _value(_code(expression), values)  # type: ignore[return-value]
