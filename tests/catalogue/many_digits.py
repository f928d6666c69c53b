"""Execute a program with any number of digits: the values of its formulas without the rounding of doubles."""

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import mpmath
import sympy as sp

from derive.ir.constants import DEGREE, EDGE
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root, Select, ToReal, Wrap
from derive.ir.program import Call, Let, Program, Require, Status
from derive.ir.symbols import is_condition
from derive.kept import kept_by_identity

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
    NearestPeriod: _nearest_period,
    NearestOnArc: _nearest_on_arc,
    ToReal: lambda n: n,
    Wrap: lambda angle: angle - 2 * mpmath.pi * mpmath.ceil(angle / (2 * mpmath.pi) - Number(1) / 2),
}
_OPERATORS: dict[type[sp.Basic], str] = {
    sp.Le: "<=", sp.Lt: "<", sp.Ge: ">=", sp.Gt: ">", sp.Eq: "==", sp.Ne: "!=", sp.And: "and", sp.Or: "or",
    sp.Add: "+", sp.Mul: "*",
}  # fmt: skip
_Run = Callable[[Mapping[str, Number]], tuple[dict[str, Number], Status]]


class _Text:
    """Python text of expressions, whose values stand in a dictionary `known`; numbers have names of their own."""

    def __init__(self) -> None:
        self.names: dict[str, object] = {kind.__name__: function for kind, function in _FUNCTIONS.items()}
        self.names["power"] = mpmath.power

    def of(self, expression: sp.Basic) -> str:
        if isinstance(expression, sp.Symbol) and expression != DEGREE:
            return f"known[{expression.name!r}]"
        if (number := _number(expression)) is not None:
            name = f"number_{len(self.names)}"
            self.names[name] = number
            return name
        parts = [self.of(argument) for argument in expression.args]
        if isinstance(expression, sp.Pow):
            whole = expression.exp.is_Integer
            return f"({parts[0]} ** {int(expression.exp)})" if whole else f"power({parts[0]}, {parts[1]})"
        if isinstance(expression, Select):
            return f"({parts[1]} if {parts[0]} else {parts[2]})"
        if isinstance(expression, sp.Not):
            return f"(not {parts[0]})"
        operator = _OPERATORS.get(type(expression))
        if operator is not None:
            return f"({f' {operator} '.join(parts)})"
        if type(expression) not in _FUNCTIONS:
            raise TypeError(f"{type(expression).__name__} has no value")
        return f"{type(expression).__name__}({', '.join(parts)})"


def _number(expression: sp.Basic) -> object:
    """A number with all digits; None for what is none."""
    if expression == sp.pi:
        return +mpmath.pi
    if expression == DEGREE:
        return mpmath.pi / 180
    if expression in (sp.true, sp.false):
        return bool(expression)
    if isinstance(expression, sp.Rational):
        return Number(int(expression.p)) / int(expression.q)
    # A constant of the product is the double that stands in every language.
    return Number(float(expression)) if isinstance(expression, sp.Number) else None


@kept_by_identity(100)
def _compiled(program: Program) -> _Run:
    """The straight-line program as a Python function, without what runs where digits are lost."""
    text = _Text()
    lines = ["def run(known):", "    known, status = dict(known), ok"]
    for statement in program.body:
        if isinstance(statement, Let):
            lines.append(f"    known[{statement.name.name!r}] = {text.of(statement.value)}")
        elif isinstance(statement, Require):
            holds = text.of(statement.condition)
            lines.append(f"    status = {statement.otherwise.name} if status is ok and not {holds} else status")
        elif isinstance(statement, Call) and statement.is_rare:
            lines.append(f"    assert not {text.of(statement.wanted)}, 'a pose that loses digits of doubles'")
            unbound = {n.name: sp.false if is_condition(n) else sp.Integer(0) for n in statement.names}
            lines += [f"    known[{name!r}] = {text.of(value)}" for name, value in unbound.items()]
        else:
            raise TypeError(f"{type(statement).__name__} is no statement of a straight line")
    outputs = ", ".join(f"{o.name!r}: {text.of(o.value)}" for o in program.outputs)
    lines.append(f"    return {{{outputs}}}, status")
    return _function("\n".join(lines), text)


def _function(lines: str, text: _Text) -> Callable[..., Any]:
    names: dict[str, Any] = text.names | {"ok": Status.OK} | {s.name: s for s in Status}
    exec(lines, names)
    return names["run"]  # type: ignore[no-any-return]


@cache
def _evaluated(expression: sp.Basic) -> Callable[[Mapping[str, Number]], Number]:
    text = _Text()
    return _function(f"def run(known):\n    return {text.of(expression)}", text)


def run_exactly(program: Program, values: Mapping[str, Number]) -> tuple[dict[str, Number], Status]:
    """Outputs and status of one call. Straight-line programs alone: no loop, no system of equations."""
    with mpmath.workdps(DIGITS):
        return _compiled(program)(values)


def evaluate_exactly(expression: sp.Basic, values: Mapping[str, Number]) -> Number:
    """An expression of a description, its symbols by their names."""
    with mpmath.workdps(DIGITS):
        return _evaluated(expression)(values)
