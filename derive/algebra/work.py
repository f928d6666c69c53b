"""The number of terms of which a product consists when it is expanded."""

from __future__ import annotations

from math import comb

import sympy as sp


def terms_of_products(expression: sp.Expr) -> int:
    """The number of products of terms that are multiplied where an expression is expanded."""
    if isinstance(expression, sp.Add):
        return sum(map(terms_of_products, expression.args))
    if isinstance(expression, sp.Mul):
        product = 1
        for factor in expression.args:
            product *= terms_of_products(factor)
        return product
    if isinstance(expression, sp.Pow) and expression.exp.is_Integer and expression.exp > 1:
        return comb(terms_of_products(expression.base) + int(expression.exp) - 1, int(expression.exp))
    return 1
