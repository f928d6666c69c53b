"""What the parts of a description must be: a part of another kind is refused with what was meant."""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Real

import sympy as sp

from derive.description.errors import DescriptionError


def expressions(what: str, given: object) -> tuple[sp.Expr, ...]:
    """Several expressions, as a tuple."""
    if not isinstance(given, Iterable) or isinstance(given, str):
        raise DescriptionError(f"{what} must be several, as in {what}=(expression,); it is {told(given)}")
    return tuple(expression(what, part) for part in given)


def expression(what: str, given: object) -> sp.Expr:
    """An expression: a quantity, and not whether something is so."""
    try:
        found = sp.sympify(given)
    except (sp.SympifyError, TypeError):
        raise DescriptionError(f"{what} holds {told(given)}, which is no expression") from None
    if not isinstance(found, sp.Expr):
        raise DescriptionError(f"{what} holds {given}, which is true or false: state the quantity whose sign tells")
    return found


def number(what: str, given: object) -> str | None:
    """What to say of what should be a number; None where it is one."""
    if not isinstance(given, Real) or isinstance(given, bool):
        return f"{what} is {told(given)}, and no number"
    return None if not math.isnan(float(given)) else f"{what} is not a number (NaN)"


def told(given: object) -> str:
    """A part as a message tells it."""
    text = " ".join(repr(given).split())
    return f"{text if len(text) <= _LONGEST else text[:_LONGEST] + '…'} (a {type(given).__name__})"


_LONGEST = 40
