"""Squared: a length that is only squared, or looked at whether it vanishes, needs no root.

    r = root(x² + y²)                                   r_squared = x² + y²
    (r - a) * (r + a) * (b - r) * (b + r) / s      →    (r_squared - a²) * (b² - r_squared) / s
    r > tolerance                                       r_squared > tolerance²

A product of a sum and a difference has no more digits than the difference of the squares: the root is rounded as they are.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations

import sympy as sp

from derive.passes import assemble, fresh, names_of
from derive.program import FREE_ANGLE, Let, Output, Program, Root, Statement, reads, real, rewritten, symbols_of


def without_roots(program: Program) -> Program:
    """The program without the roots of such lengths."""
    for let in program.lets():
        if isinstance(let.value, Root):
            program = _without_root(program, let.name) or program
    return program


def _without_root(program: Program, length: sp.Symbol) -> Program | None:
    """The program with the square of a length; None where something else is made of it."""
    square = fresh(real(f"{length.name}_squared"), names_of(program))

    def changed(value: sp.Basic) -> sp.Basic:
        return _in_squares(value, length, square)

    body: list[Statement] = []
    for s in program.body:
        is_length = isinstance(s, Let) and s.name == length
        body.append(Let(square, s.value.args[0], s.note) if isinstance(s, Let) and is_length else rewritten(s, changed))
    outputs = [Output(o.name, changed(o.value)) for o in program.outputs]
    read = set().union(*map(reads, body), *(symbols_of(o.value) for o in outputs))
    return None if length in read else assemble(program.name, body, outputs)


def _in_squares(value: sp.Basic, length: sp.Symbol, square: sp.Symbol) -> sp.Basic:
    """A value with the square of a length wherever that is enough."""
    table: dict[sp.Basic, sp.Basic] = {length**2: square}
    for node in sp.preorder_traversal(value):
        if isinstance(node, sp.Mul):
            table |= _conjugates(node, length, square)
        elif isinstance(node, sp.StrictGreaterThan) and node.lhs == length and _is_tolerance(node.rhs):
            table[node] = sp.Gt(square, node.rhs**2)
    return value.xreplace(table)


def _conjugates(product: sp.Mul, length: sp.Symbol, square: sp.Symbol) -> Mapping[sp.Basic, sp.Basic]:
    """The product with its pairs (r + a)(r - a) as r² - a²."""
    factors = list(product.args)
    for first, second in combinations(product.args, 2):
        for sign in (1, -1):
            rest = sp.expand(first - length)
            are_conjugate = length in first.free_symbols - rest.free_symbols and second == sign * (length - rest)
            if are_conjugate and first in factors and second in factors:
                factors = [f for f in factors if f not in (first, second)] + [sign * (square - rest**2)]
    return {product: sp.Mul(*factors)} if len(factors) < len(product.args) else {}


def _is_tolerance(value: sp.Expr) -> bool:
    """Whether a value is a share of the machine that counts as nothing: it is not negative."""
    return FREE_ANGLE in sp.Mul.make_args(value)
