"""The types of the intermediate representation, and what may be made of each.

    Real     a number
    Bool     a condition, and a name that is one: `flag`
    Int      a whole number: `count`. It is compared with, added to and multiplied with whole numbers; `ToReal` makes it a Real

A whole number that is written down is an Int or a Real, as its neighbours are.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum

import sympy as sp
from sympy.core.relational import Relational

from derive.ir.primitives import (
    Atan2,
    NearestOnArc,
    NearestPeriod,
    Root,
    Select,
    ToReal,
)
from derive.ir.symbols import Flag, is_count


class Type(Enum):
    """What an expression is."""

    REAL = "real"
    BOOL = "bool"
    INT = "int"
    WRITTEN = "a whole number that is written down"
    """An Int or a Real."""


class IllTypedError(Exception):
    """An expression that mixes types; the message says which part."""


_NUMBERS = (Type.REAL, Type.INT)


def type_of(value: sp.Basic) -> Type:
    """The type of an expression, through all of its parts; raises `IllTypedError`."""
    if isinstance(value, sp.Symbol):
        return Type.BOOL if isinstance(value, Flag) else Type.INT if is_count(value) else Type.REAL
    if isinstance(value, sp.Number | sp.NumberSymbol):
        return Type.WRITTEN if value.is_Integer else Type.REAL
    if value in (sp.true, sp.false):
        return Type.BOOL
    rule = next((rule for kind, rule in _RULES.items() if isinstance(value, kind)), None)
    if rule is None:
        raise IllTypedError(f"{type(value).__name__} is not a primitive")
    return rule(value)


def type_of_name(name: sp.Symbol) -> Type:
    """The type that a name is declared with."""
    return type_of(name)


def fits(found: Type, wanted: Type) -> bool:
    """Whether a value of one type may be bound to a name of the other."""
    return found is wanted or (found is Type.WRITTEN and wanted in _NUMBERS)


def _same(value: sp.Basic, parts: Iterable[sp.Basic], among: tuple[Type, ...]) -> Type:
    """The one type of some parts, which must be among these."""
    found = {type_of(part) for part in parts}
    named = found - {Type.WRITTEN}
    if len(named) > 1 or not named <= {*among}:
        raise IllTypedError(f"{value} mixes types: {', '.join(sorted(t.value for t in found))}")
    return named.pop() if named else Type.WRITTEN


def _reals(value: sp.Basic) -> Type:
    _same(value, value.args, (Type.REAL,))
    return Type.REAL


def _numbers(value: sp.Basic) -> Type:
    return _same(value, value.args, _NUMBERS)


def _power(value: sp.Basic) -> Type:
    """A whole number has no reciprocal."""
    base, exponent = value.args
    found = _same(value, (base,), _NUMBERS)
    return found if exponent.is_positive and found is not Type.WRITTEN else _same(value, (base,), (Type.REAL,))


def _comparison(value: sp.Basic) -> Type:
    """Only whole numbers are equal: of two reals this would depend on rounding."""
    among = (Type.INT,) if isinstance(value, sp.Eq | sp.Ne) else _NUMBERS
    _same(value, value.args, among)
    return Type.BOOL


def _logic(value: sp.Basic) -> Type:
    return _same(value, value.args, (Type.BOOL,))


def _opposite(value: sp.Basic) -> Type:
    """Of a name alone: the opposite of a comparison would hold for not-a-number."""
    if not isinstance(value.args[0], Flag):
        raise IllTypedError(f"{value} is not the opposite of a flag")
    return Type.BOOL


def _choice(value: sp.Basic) -> Type:
    condition, first, second = value.args
    _same(value, (condition,), (Type.BOOL,))
    return _same(value, (first, second), _NUMBERS)


def _converted(value: sp.Basic) -> Type:
    _same(value, value.args, (Type.INT,))
    return Type.REAL


_RULES: dict[type[sp.Basic], Callable[[sp.Basic], Type]] = {
    sp.Add: _numbers,
    sp.Mul: _numbers,
    sp.Pow: _power,
    sp.Abs: _numbers,
    sp.sin: _reals,
    sp.cos: _reals,
    Root: _reals,
    Atan2: _reals,
    NearestPeriod: _reals,
    NearestOnArc: _reals,
    Select: _choice,
    ToReal: _converted,
    Relational: _comparison,
    sp.And: _logic,
    sp.Or: _logic,
    sp.Not: _opposite,
}
"""What every operation makes of the types of its parts."""
