"""Names for known values: one symbol per value, so that discriminants stay factored and programs read well."""

from __future__ import annotations

import re

import sympy as sp

from derive.algebra.angle_sums import name_of, recognise
from derive.algebra.normal_form import is_compound
from derive.equations.problem import Problem
from derive.ir.primitives import Root
from derive.ir.program import Let
from derive.ir.symbols import real


class Naming:
    """Collects the bindings of the known values of one subproblem. Equal values share a name."""

    def __init__(self, problem: Problem, lets: tuple[Let, ...] = ()) -> None:
        self._known = tuple(a for a in problem.units if a not in problem.angles)
        self._lets: list[Let] = list(lets)

    @property
    def lets(self) -> tuple[Let, ...]:
        """The bindings so far, in order."""
        return tuple(self._lets)

    def named(self, value: sp.Expr, proposal: str, note: str = "") -> sp.Expr:
        """The value itself where it is a symbol or a number, else its name, or minus the name of its negative."""
        if not is_compound(value):
            return value
        if all(term.could_extract_minus_sign() for term in sp.Add.make_args(value)):
            return -self.named(-value, proposal, note)
        sum_of_angles = recognise(value, self._known)
        if sum_of_angles is not None:
            sign, word, terms = sum_of_angles
            return sign * self._bind(real(f"{word}_{name_of(terms)}"), sp.expand(sign * value), note)
        return self._bind(real(_portable(proposal)), value, note)

    def product(self, value: sp.Expr, proposal: str, note: str = "") -> sp.Expr:
        """The name of a product of lengths; no sign is taken out of it."""
        return self._bind(real(_portable(proposal)), value, note)

    def length(self, proposal: str, *sides: sp.Expr, note: str = "") -> sp.Expr:
        """The name of the length of a vector: the root of the sum of its squared sides."""
        return self._bind(real(proposal), Root(sp.Add(*[side**2 for side in sides])), note)

    def _bind(self, name: sp.Symbol, value: sp.Expr, note: str) -> sp.Expr:
        for let in self._lets:
            if let.value == value:
                return let.name
            if let.value == -value:
                return -let.name
        free, number = name, 1
        while any(let.name == free for let in self._lets):
            number += 1
            free = real(f"{name.name}_{number}")
        self._lets.append(Let(free, value, note))
        return free


def _portable(proposal: str) -> str:
    """The proposal as an identifier: "a1 radius_of_a2" becomes a1_radius_of_a2."""
    return re.sub(r"[^a-z0-9]+", "_", proposal).strip("_")
