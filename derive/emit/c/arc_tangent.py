"""The arc tangent as a polynomial, which a compiler can vectorise, unlike a call of the C library.

atan t = t + t z p(z) with z = t², for t from 0 to tan 22.5°: angles of all octants follow from these by symmetry.
p interpolates at Chebyshev's nodes: with eleven coefficients its error is below rounding.
"""

from __future__ import annotations

from functools import cache

import sympy as sp

from derive.emit.c.printer import number

_COUNT = 11
_DIGITS = 40
_TOP = (sp.sqrt(2) - 1) ** 2
"""The square of tan 22.5°."""


@cache
def coefficients() -> tuple[float, ...]:
    """The coefficients of p, from that of 1 on."""
    nodes = [sp.N((1 + sp.cos((2 * k + 1) * sp.pi / (2 * _COUNT))) * _TOP / 2, _DIGITS) for k in range(_COUNT)]
    powers = sp.Matrix(_COUNT, _COUNT, lambda i, j: nodes[i] ** j)
    values = sp.Matrix([(sp.atan(sp.sqrt(z)) / sp.sqrt(z) - 1) / z for z in nodes])
    return tuple(float(c) for c in powers.LUsolve(values))


def horner(square: str) -> tuple[str, str]:
    """The terms of p with even and with odd powers, in C: two chains, which a processor computes side by side.

    square: the name of z².
    """
    even, odd = (_nested(coefficients()[start::2], square) for start in (0, 1))
    return even, odd


def _nested(numbers: tuple[float, ...], square: str) -> str:
    first, *others = (number(value) for value in numbers)
    if len(others) < 2:
        return " + ".join([first, *(f"{square}*{other}" for other in others)])
    return f"{first} + {square}*({_nested(numbers[1:], square)})"
