"""Normal forms: polynomials in the sines and cosines of angles, modulo sin^2 + cos^2 = 1.

An angle `a2` is expressed by two symbols, `sin_a2` and `cos_a2`, from the first equation to the last
statement: an unknown of the solver becomes a named temporary of the program.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache

import sympy as sp

from derive.algebra.rings import is_rational, reduced_in_ring, terms_of_products
from derive.ir.constants import DEGREE
from derive.ir.symbols import cosine, sine
from derive.work import counted, spend


def polynomial(expression: sp.Expr, angles: Sequence[sp.Symbol], signs: Sequence[sp.Symbol]) -> sp.Expr:
    """The expanded polynomial of an expression: sines and cosines of sums become products of symbols.

    `signs` are parameters that are +1 or -1 (never zero: their squares are one, and they leave the argument of a
    cosine), and flags that are 0 or 1 (their squares are themselves).
    """
    return _polynomial(sp.sympify(expression), tuple(angles), tuple(signs))


@counted
def _polynomial(expression: sp.Expr, angles: tuple[sp.Symbol, ...], signs: tuple[sp.Symbol, ...]) -> sp.Expr:
    if _is_expanded(expression) and not expression.has(sp.sin, sp.cos):
        return reduce_units(expression, angles, signs)
    plain = _in_symbols(expression, angles, signs)
    if is_rational(plain):
        return reduce_units(plain, angles, signs)
    terms = sp.expand_trig(sp.expand(expression))  # a sign leaves an argument only where that is no sum
    expanded = _without_signs(terms, signs)
    expanded = expanded.subs(sp.pi, 180 * DEGREE) if expanded.has(sp.pi) else expanded
    return reduce_units(expanded.xreplace(_functions(angles)), angles, signs)


def _in_symbols(expression: sp.Expr, angles: tuple[sp.Symbol, ...], signs: tuple[sp.Symbol, ...]) -> sp.Expr:
    """The expression with symbols for its sines and cosines, also for those of sums that contain no sign."""
    plain = expression.xreplace(_functions(angles))
    left = plain.atoms(sp.sin, sp.cos)
    if not left or any(node.free_symbols & {*signs} for node in left):
        return plain
    opened = {node: sp.expand_trig(node.func(sp.expand(node.args[0]))).xreplace(_functions(angles)) for node in left}
    return plain.xreplace(opened)


@cache
def _functions(angles: tuple[sp.Symbol, ...]) -> dict[sp.Expr, sp.Expr]:
    """Sines and cosines with the symbol of each; a fixed angle of the machine is in degrees."""
    written = ((angle, angle * unit) for angle in angles for unit in (1, DEGREE))
    return {of(w): name(a) for a, w in written for of, name in ((sp.sin, sine), (sp.cos, cosine))}


def _without_signs(expression: sp.Expr, signs: Sequence[sp.Symbol]) -> sp.Expr:
    for sign in (s for s in signs if s.is_nonzero):
        expression = _without_sign(expression, sign)
    return expression


def _without_sign(expression: sp.Expr, sign: sp.Symbol) -> sp.Expr:
    """cos(s u) = cos(u), sin(s u) = s sin(u) for s = ±1."""
    return expression.replace(
        lambda node: isinstance(node, sp.sin | sp.cos) and _is_multiple(node.args[0], sign),
        lambda node: node.func(sp.expand(node.args[0] / sign)) * (sign if isinstance(node, sp.sin) else 1),
    )


def _is_multiple(argument: sp.Expr, sign: sp.Symbol) -> bool:
    return all(sign in term.free_symbols for term in sp.Add.make_args(sp.expand(argument)))


@cache
def _reduction(angles: tuple[sp.Symbol, ...], signs: tuple[sp.Symbol, ...]) -> dict[sp.Symbol, sp.Expr]:
    table: dict[sp.Symbol, sp.Expr] = {sine(a): 1 - cosine(a) ** 2 for a in angles}
    table.update({s: sp.Integer(1) if s.is_nonzero else s for s in signs})
    return table


def reduce_units(expression: sp.Expr, angles: Sequence[sp.Symbol], signs: Sequence[sp.Symbol] = ()) -> sp.Expr:
    """The expanded normal form: the square of a sine becomes 1 - cos^2, of a sign 1, of a flag the flag."""
    return _reduced(sp.sympify(expression), tuple(angles), tuple(signs))


@counted
def _reduced(expression: sp.Expr, angles: tuple[sp.Symbol, ...], signs: tuple[sp.Symbol, ...]) -> sp.Expr:
    table = _reduction(angles, signs)
    if is_rational(expression):
        return reduced_in_ring(expression, table)

    def lower(power: sp.Pow) -> sp.Expr:
        return table[power.base] ** (power.exp // 2) * power.base ** (power.exp % 2)

    spend(terms_of_products(expression))
    expanded = expression if _is_expanded(expression) else sp.expand(expression)
    while True:
        if not any(p.base in table and p.exp.is_Integer and p.exp >= 2 for p in expanded.atoms(sp.Pow)):
            return expanded
        lowered = expanded.replace(
            lambda n: isinstance(n, sp.Pow) and n.base in table and n.exp.is_Integer and n.exp >= 2, lower
        )
        if lowered == expanded:
            return expanded
        spend(terms_of_products(lowered))
        expanded = sp.expand(lowered)


def _is_expanded(expression: sp.Expr) -> bool:
    """Whether an expression is a sum of products of symbols, numbers, and sines and cosines of such sums, so that
    nothing can be expanded.
    """
    return all(_is_monomial(term) for term in sp.Add.make_args(expression))


def _is_monomial(term: sp.Expr) -> bool:
    return all(f.is_Number or _is_plain(*f.as_base_exp()) for f in sp.Mul.make_args(term))


def _is_plain(base: sp.Expr, exponent: sp.Expr) -> bool:
    """Whether a factor is a power of a symbol, of a sine or of a cosine, or the root of a whole number."""
    if base.is_Symbol or (isinstance(base, sp.sin | sp.cos) and _is_expanded(base.args[0])):
        return bool(exponent.is_Integer and exponent.is_positive)
    return bool(base.is_Integer and base.is_positive and exponent == sp.Rational(1, 2))


def linear_coefficients(expression: sp.Expr, atoms: Sequence[sp.Symbol]) -> tuple[list[sp.Expr], sp.Expr] | None:
    """The coefficients of the atoms, and the rest, where the expression is linear in all of them
    together; else None.
    """
    found = _linear(expression, tuple(atoms))
    return None if found is None else (list(found[:-1]), found[-1])


@counted
def _linear(expression: sp.Expr, atoms: tuple[sp.Symbol, ...]) -> tuple[sp.Expr, ...] | None:
    """The coefficients, then the rest. Cached: every rule examines the same equations."""
    if _is_expanded(expression):
        return _collected(expression, atoms)
    try:
        poly = sp.Poly(expression, *atoms)
    except sp.PolynomialError:
        return None
    if poly.total_degree() > 1:
        return None
    return tuple(sp.sympify(poly.coeff_monomial(monomial)) for monomial in (*atoms, 1))


def _collected(expression: sp.Expr, atoms: tuple[sp.Symbol, ...]) -> tuple[sp.Expr, ...] | None:
    """The coefficients and the rest of an expanded polynomial: its terms, sorted by the atom that each contains."""
    places = {atom: place for place, atom in enumerate(atoms)}
    parts: list[list[sp.Expr]] = [[] for _ in (*atoms, 1)]
    for term in sp.Add.make_args(expression):
        factors = sp.Mul.make_args(term)
        found = [f for f in factors if not f.is_number and not f.free_symbols.isdisjoint(places)]
        if len(found) > 1 or (found and not found[0].is_Symbol):
            return None
        if found:
            parts[places[found[0]]].append(sp.Mul(*[f for f in factors if f is not found[0]]))
        else:
            parts[-1].append(term)
    return tuple(sp.Add(*terms) for terms in parts)


def split_known(expression: sp.Expr, unknown: Iterable[sp.Symbol]) -> tuple[sp.Expr, sp.Expr]:
    """The sum of the terms with an unknown, and the sum of those without."""
    return _split_known(expression, frozenset(unknown))


@counted
def _split_known(expression: sp.Expr, atoms: frozenset[sp.Symbol]) -> tuple[sp.Expr, sp.Expr]:
    moving, known = list[sp.Expr](), list[sp.Expr]()
    for term in sp.Add.make_args(expression if _is_expanded(expression) else sp.expand(expression)):
        (known if atoms.isdisjoint(term.free_symbols) else moving).append(term)
    return sp.Add(*moving), sp.Add(*known)


@counted
def cancelled(value: sp.Expr) -> sp.Expr:
    """A quotient of polynomials in lowest terms. Cached: every rule meets the same equations again after each step."""
    return sp.cancel(value)


@counted
def factored(value: sp.Expr) -> sp.Expr:
    """A value in factored form; a sum that has fewer products with its fraction inside has it there. Cached, as
    `cancelled` is.
    """
    found = value if len(value.free_symbols) > _MOST_SYMBOLS else sp.factor(value)
    number, rest = found.as_coeff_Mul()
    if not number.is_Rational or number.is_Integer or not rest.is_Add:
        return found
    inside = sp.Add(*[number * term for term in rest.args])
    return inside if _products(inside) <= _products(rest) else found


_MOST_SYMBOLS = 30
"""To look for the factors of a sum of more symbols takes minutes; it stays as it is."""


def factors_of(value: sp.Expr) -> tuple[sp.Expr, ...]:
    """The factors of a value; of a sum of very many symbols its number alone."""
    many = len(value.free_symbols) > _MOST_SYMBOLS
    found: tuple[sp.Expr, ...] = value.primitive() if many else sp.Mul.make_args(sp.factor(value))
    return found


def _products(value: sp.Expr) -> int:
    """The number of terms of a sum that are multiplied by a number."""
    return sum(not term.is_number and abs(term.as_coeff_Mul()[0]) != 1 for term in value.args)


def is_compound(expression: sp.Expr) -> bool:
    """Whether an expression is worth a name of its own: anything but a symbol, a number, or their negative."""
    return not (expression.is_Atom or (-expression).is_Atom)
