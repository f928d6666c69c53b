"""Sums of angles: their names, and the addition theorems read backwards."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import product

import sympy as sp

from derive.algebra.normal_form import polynomial
from derive.ir.symbols import cosine, real, sine

Terms = tuple[tuple[sp.Symbol, int], ...]


def name_of(terms: Terms) -> str:
    """The name of a sum: "a12" for a1 + a2, "theta_phi" for theta + phi, "a2_from_a1" for a2 - a1."""
    plus = [a.name for a, sign in terms if sign > 0]
    minus = [a.name for a, sign in terms if sign < 0]
    return "_from_".join(_joined(names) for names in (plus, minus) if names)


def _joined(names: Sequence[str]) -> str:
    parts = [re.fullmatch(r"([a-z]+)(\d+)", n) for n in names]
    found = [p for p in parts if p is not None]
    if len(found) == len(names) and len({p[1] for p in found}) == 1:
        return found[0][1] + "".join(p[2] for p in found)
    return "_".join(names)


def symbol_of_sum(terms: Terms) -> sp.Symbol:
    """The symbol of a sum of angles."""
    return real(name_of(terms))


def positive_first(terms: Terms) -> Terms:
    """The terms, with all signs changed where every term is subtracted: only then does the sum have a name."""
    return terms if any(sign > 0 for _, sign in terms) else tuple((a, -sign) for a, sign in terms)


def terms_of(argument: sp.Expr, angles: Sequence[sp.Symbol]) -> Terms | None:
    """The angles of an argument with their signs; None if it is no sum of angles with coefficients ±1."""
    found = tuple((a, int(argument.coeff(a))) for a in angles if argument.coeff(a) in (1, -1))
    rebuilt = sp.Add(*[a * s for a, s in found])
    return found if found and sp.expand(argument - rebuilt) == 0 else None


def recognise(expression: sp.Expr, angles: Sequence[sp.Symbol]) -> tuple[int, str, Terms] | None:
    """(sign, "cos" or "sin", terms) where the expression is ± the cosine or sine of a sum of two or more angles."""
    present = tuple(a for a in angles if expression.free_symbols & {sine(a), cosine(a)})
    if len(present) < 2 or expression.free_symbols - {f(a) for a in present for f in (sine, cosine)}:
        return None
    for signs in product((1, -1), repeat=len(present) - 1):
        terms: Terms = tuple(zip(present, (1, *signs), strict=True))
        argument = sp.Add(*[a * s for a, s in terms])
        for word, function in (("cos", sp.cos), ("sin", sp.sin)):
            form = polynomial(function(argument), present, ())
            if sp.expand(expression - form) == 0:
                return 1, word, terms
            if sp.expand(expression + form) == 0:
                return -1, word, terms
    return None
