"""SymPy expressions of a description as CasADi expressions, independently of the derivation."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from functools import reduce
from operator import add, mul
from typing import Any

import casadi as ca
import sympy as sp

from derive.description.mechanism import DescriptionError
from derive.ir.constants import DEGREE
from derive.ir.primitives import Select

Term = Any
"""A CasADi expression (`casadi.SX`) or a number; CasADi carries no types."""
Symbols = dict[sp.Symbol, Term]
"""The symbols of a description, with their CasADi expressions."""

_FUNCTIONS: dict[type[sp.Basic], Callable[..., Term]] = {
    sp.Add: lambda *terms: reduce(add, terms),
    sp.Mul: lambda *factors: reduce(mul, factors),
    sp.Pow: lambda base, exponent: base**exponent,
    sp.sin: ca.sin,
    sp.cos: ca.cos,
    sp.Abs: ca.fabs,
    sp.sign: ca.sign,
    sp.Gt: operator.gt,
    Select: ca.if_else,
}


def term(expression: sp.Basic, symbols: Mapping[sp.Symbol, Term]) -> Term:
    """The expression over CasADi symbols; angles are in radians on both sides."""
    if expression == DEGREE:
        return float(sp.pi) / 180.0
    if isinstance(expression, sp.Symbol):
        if expression not in symbols:
            raise DescriptionError(f"{expression} is neither a joint nor a parameter")
        return symbols[expression]
    if isinstance(expression, sp.Number | sp.NumberSymbol):
        return float(expression)
    if type(expression) not in _FUNCTIONS:
        raise DescriptionError(f"{expression.func} has no place in a description: {expression}")
    return _FUNCTIONS[type(expression)](*(term(a, symbols) for a in expression.args))
