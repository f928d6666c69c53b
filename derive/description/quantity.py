"""Joints and parameters as they stand in equations: a symbol with a meaning."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Quantity:
    """A quantity with a symbol, by which it stands in SymPy expressions."""

    symbol: sp.Symbol

    def _sympy_(self) -> sp.Symbol:
        return self.symbol

    def __add__(self, other: object) -> sp.Expr:
        return self.symbol + sp.sympify(other)

    def __radd__(self, other: object) -> sp.Expr:
        return sp.sympify(other) + self.symbol

    def __sub__(self, other: object) -> sp.Expr:
        return self.symbol - sp.sympify(other)

    def __rsub__(self, other: object) -> sp.Expr:
        return sp.sympify(other) - self.symbol

    def __mul__(self, other: object) -> sp.Expr:
        return self.symbol * sp.sympify(other)

    def __rmul__(self, other: object) -> sp.Expr:
        return sp.sympify(other) * self.symbol

    def __truediv__(self, other: object) -> sp.Expr:
        return self.symbol / sp.sympify(other)

    def __pow__(self, other: int) -> sp.Expr:
        return self.symbol**other

    def __neg__(self) -> sp.Expr:
        return -self.symbol
