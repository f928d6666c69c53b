"""The types of the intermediate representation, the operations on each, and the check of a whole program.

    Real     a number
    Bool     a condition, or a name made by `flag`
    Int      an integer, or a name made by `count`. It is compared with, added to and multiplied by integers; `ToReal`
             makes it a Real
    Angle    a Real modulo a turn, in radians. It comes from `Atan2` and `NearestOnArc`. It has sums, integer multiples,
             choices, a sine and a cosine. `Wrap` makes it a Real; every other use is refused
    Heading  an Angle in degrees, the unit of axes: `NearestPeriod` makes it a Real

A literal integer is an Int or a Real, as its neighbours are. A flag and a count have their types by their names; a name
is an angle if an angle is bound to it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import Enum
from functools import cache

import sympy as sp
from sympy.core.relational import Relational

from derive.ir.constants import DEGREE
from derive.ir.primitives import PRIMITIVES, Atan2, NearestOnArc, NearestPeriod, Select, ToReal, Wrap
from derive.ir.program import Call, Iterate, Let, Program, Require, Solve, Statement
from derive.ir.symbols import Flag, is_count, is_decided, names_in


class Type(Enum):
    """The type of an expression."""

    REAL = "real"
    BOOL = "bool"
    INT = "int"
    WRITTEN = "a whole number that is written down"
    """An Int or a Real."""
    ANGLE = "angle"
    HEADING = "angle in degrees"


class IllTypedError(Exception):
    """An expression that mixes types; the message says which part."""


Known = Mapping[sp.Symbol, Type]
"""The names that are angles."""
_NUMBERS = (Type.REAL, Type.INT)
TURNING = (Type.ANGLE, Type.HEADING)
"""The types of values that are defined modulo a turn."""
_NOTHING: Known = {}


def type_of(value: sp.Basic, known: Known = _NOTHING) -> Type:
    """The type of an expression, from those of its parts. Raises `IllTypedError`."""
    names = names_in(value)
    if known.keys().isdisjoint(names):
        return _type_of(value, frozenset())
    return _type_of(value, frozenset((name, known[name]) for name in names if name in known))


@cache
def _type_of(value: sp.Basic, angles: frozenset[tuple[sp.Symbol, Type]]) -> Type:
    """The type of an expression, given the names in it that are angles. Cached: every pass also checks the expressions
    that it has not changed.
    """
    known = dict(angles)
    if isinstance(value, sp.Symbol):
        return Type.BOOL if isinstance(value, Flag) else Type.INT if is_count(value) else known.get(value, Type.REAL)
    if isinstance(value, sp.Number | sp.NumberSymbol):
        return Type.WRITTEN if value.is_Integer else Type.REAL
    if is_decided(value):
        return Type.BOOL
    rule = next((rule for kind, rule in _RULES.items() if isinstance(value, kind)), _reals)
    if rule is _reals and not isinstance(value, PRIMITIVES):
        raise IllTypedError(f"{type(value).__name__} is not a primitive")
    return rule(value, [type_of(part, known) for part in value.args])


def fits(found: Type, wanted: Type) -> bool:
    """Whether a value of one type may be bound to a name of the other: any number is an angle, too."""
    if wanted in TURNING:
        return found in (wanted, Type.REAL, Type.WRITTEN)
    return found is wanted or (found is Type.WRITTEN and wanted in _NUMBERS)


def angles_in(body: Iterable[Statement]) -> dict[sp.Symbol, Type]:
    """The names that are bound to angles; raises `IllTypedError`."""
    known: dict[sp.Symbol, Type] = {}
    for statement in body:
        known |= angles_of(statement, known)
    return known


def angles_of(statement: Statement, known: Known) -> dict[sp.Symbol, Type]:
    """The names that a statement binds to angles, given those that are already known."""
    found: dict[sp.Symbol, Type] = {}
    if isinstance(statement, Let):
        found = {statement.name: type_of(statement.value, known)}
    elif isinstance(statement, Iterate):
        found = {name: type_of(value, known) for name, value in zip(statement.state, statement.start, strict=True)}
        for inner in statement.step:
            found |= angles_of(inner, {**known, **found})
    elif isinstance(statement, Call):
        types = output_types(statement.program)
        found = {name: types[name.name] for name in statement.names}
    return {name: kind for name, kind in found.items() if kind in TURNING}


def output_types(program: Program) -> dict[str, Type]:
    """The types of the outputs of a program."""
    known = angles_in(program.body)
    return {output.name: type_of(output.value, known) for output in program.outputs}


def check_types(program: Program) -> None:
    """Raise `IllTypedError` for a statement or an output that mixes types."""
    known: dict[sp.Symbol, Type] = {}
    for statement in program.body:
        known |= check_statement(statement, known)
    for output in program.outputs:
        type_of(output.value, known)


def check_statement(statement: Statement, known: Known) -> dict[sp.Symbol, Type]:
    """The names that a statement binds to angles, given the `known` ones; raises `IllTypedError` if it mixes types."""
    if isinstance(statement, Let):
        return _check_let(statement, known)
    bound = angles_of(statement, known)
    if isinstance(statement, Iterate):
        _check_loop(statement, known, {**known, **bound})
        return bound
    for value, wanted in _wanted(statement):
        _check(value, type_of(value, known), wanted)
    if isinstance(statement, Call):
        types = output_types(statement.program)
        for name in statement.names:
            _check(name, types[name.name], type_of(name, bound))
    return bound


def _check_let(let: Let, known: Known) -> dict[sp.Symbol, Type]:
    found = type_of(let.value, known)
    bound = {let.name: found} if found in TURNING else {}
    wanted = type_of(let.name, bound)
    if found is not wanted:
        _check(let.value, found, wanted)
    return bound


def _wanted(statement: Statement) -> Iterator[tuple[sp.Basic, Type]]:
    """The values of a statement other than a `Let`, with the types that they must have."""
    if isinstance(statement, Require):
        yield statement.condition, Type.BOOL
    elif isinstance(statement, Solve):
        yield from ((value, Type.REAL) for value in (*statement.matrix, *statement.right))
    elif isinstance(statement, Call):
        yield from ((value, type_of(name)) for name, value in statement.given)
        yield statement.wanted, Type.BOOL


def _check_loop(loop: Iterate, known: Known, inside: Known) -> None:
    """known, inside: the names that are angles in front of the loop, and in it."""
    for inner in loop.step:
        check_statement(inner, inside)
    for name, start, following in zip(loop.state, loop.start, loop.following, strict=True):
        _check(start, type_of(start, known), type_of(name, inside))
        _check(following, type_of(following, inside), type_of(name, inside))
    _check(loop.done, type_of(loop.done, inside), Type.BOOL)


def _check(value: sp.Basic, found: Type, wanted: Type) -> None:
    if not fits(found, wanted):
        raise IllTypedError(f"{value} is {found.value}, and {wanted.value} is wanted")


def _same(value: sp.Basic, found: Sequence[Type], *among: Type) -> Type:
    """The common type of some parts, which must be one of `among`."""
    named = {*found} - {Type.WRITTEN}
    if len(named) > 1 or not named <= {*among}:
        raise IllTypedError(f"{value} mixes types: {', '.join(sorted(t.value for t in {*found}))}")
    return named.pop() if named else Type.WRITTEN


def _turning(value: sp.Basic, found: Sequence[Type]) -> Type | None:
    """The angle type among some parts, if any; all others must be numbers."""
    kinds = [kind for kind in TURNING if kind in found]
    return _same(value, [t for t in found if t is not Type.REAL], *kinds) if kinds else None


def _reals(value: sp.Basic, found: Sequence[Type]) -> Type:
    _same(value, found, Type.REAL)
    return Type.REAL


def _numbers(value: sp.Basic, found: Sequence[Type]) -> Type:
    return _same(value, found, *_NUMBERS)


def _sum(value: sp.Basic, found: Sequence[Type]) -> Type:
    return _turning(value, found) or _numbers(value, found)


def _product(value: sp.Basic, found: Sequence[Type]) -> Type:
    """The type of a product: an integer multiple of an angle, or an angle in degrees."""
    factors = [(f, kind) for f, kind in zip(value.args, found, strict=True) if kind is not Type.WRITTEN]
    if len(factors) == 2 and factors[0][0] == 1 / DEGREE and factors[1][1] is Type.ANGLE:
        return Type.HEADING
    if len(factors) == 2 and factors[1][0] == 1 / DEGREE and factors[0][1] is Type.ANGLE:
        return Type.HEADING
    return factors[0][1] if len(factors) == 1 and factors[0][1] in TURNING else _numbers(value, found)


def _power(value: sp.Basic, found: Sequence[Type]) -> Type:
    """The type of a power: an integer has no reciprocal."""
    kind = _same(value, found[:1], *_NUMBERS)
    return kind if value.args[1].is_positive else _same(value, found[:1], Type.REAL)


def _comparison(value: sp.Basic, found: Sequence[Type]) -> Type:
    """A comparison of numbers; equality of integers only, because for reals it would depend on rounding."""
    _same(value, found, *((Type.INT,) if isinstance(value, sp.Eq | sp.Ne) else _NUMBERS))
    return Type.BOOL


def _logic(value: sp.Basic, found: Sequence[Type]) -> Type:
    return _same(value, found, Type.BOOL)


def _opposite(value: sp.Basic, found: Sequence[Type]) -> Type:
    """Negation, of a flag only: the negation of a comparison would hold for NaN."""
    if not isinstance(value.args[0], Flag):
        raise IllTypedError(f"{value} is not the opposite of a flag")
    return Type.BOOL


def _choice(value: sp.Basic, found: Sequence[Type]) -> Type:
    _same(value, found[:1], Type.BOOL)
    return _turning(value, found[1:]) or _numbers(value, found[1:])


def _converted(value: sp.Basic, found: Sequence[Type]) -> Type:
    _same(value, found, Type.INT)
    return Type.REAL


def _of_angle(value: sp.Basic, found: Sequence[Type]) -> Type:
    if found[0] is not Type.ANGLE:
        _same(value, found, Type.REAL)
    return Type.REAL


def _direction(value: sp.Basic, found: Sequence[Type]) -> Type:
    _same(value, found, Type.REAL)
    return Type.ANGLE


def _on_arc(value: sp.Basic, found: Sequence[Type]) -> Type:
    """The nearest angle on an arc: angle and centre are angles, half the arc is a Real."""
    _turning(value, found[:2])
    _same(value, found[2:], Type.REAL)
    return Type.ANGLE


def _period(value: sp.Basic, found: Sequence[Type]) -> Type:
    if found[0] is not Type.HEADING:
        _same(value, found[:1], Type.REAL)
    return _same(value, found[1:], Type.REAL) and Type.REAL


_RULES: dict[type[sp.Basic], Callable[[sp.Basic, Sequence[Type]], Type]] = {
    sp.Add: _sum,
    sp.Mul: _product,
    sp.Pow: _power,
    sp.Abs: _numbers,
    sp.sin: _of_angle,
    sp.cos: _of_angle,
    Atan2: _direction,
    Wrap: _of_angle,
    NearestPeriod: _period,
    NearestOnArc: _on_arc,
    Select: _choice,
    ToReal: _converted,
    Relational: _comparison,
    sp.And: _logic,
    sp.Or: _logic,
    sp.Not: _opposite,
}
"""For each operation, the function from the types of its parts to the type of its result; any other primitive makes a
Real of Reals."""
