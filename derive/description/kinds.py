"""The kinds that parts of a description must have: the message about any other kind says which was expected."""

from __future__ import annotations

import math
from collections.abc import Iterable
from numbers import Real

import sympy as sp

from derive.description.errors import DescriptionError


def expressions(what: str, given: Iterable[object]) -> tuple[sp.Expr, ...]:
    """Several expressions, as a tuple."""
    return tuple(expression(what, part) for part in given)


def expression(what: str, given: object) -> sp.Expr:
    """An expression: it has a value, and is no condition."""
    try:
        found = sp.sympify(given)
    except (sp.SympifyError, TypeError):
        raise DescriptionError(f"{what} holds {described(given)}, which is no expression") from None
    if not isinstance(found, sp.Expr):
        raise DescriptionError(f"{what} holds {given}, which is true or false: state the quantity whose sign tells")
    return found


def number(what: str, given: object) -> str | None:
    """The message where a part should be a number and is none; None if it is one."""
    if not isinstance(given, Real) or isinstance(given, bool):
        return f"{what} is {described(given)}, and no number"
    return None if not math.isnan(float(given)) else f"{what} is not a number (NaN)"


def pair(what: str, given: object) -> str | None:
    """The message where a part should be the two ends of a range; None if it is."""
    is_pair = isinstance(given, tuple | list) and len(given) == 2 and not any(number("", end) for end in given)
    return None if is_pair else f"its {what} is {described(given)}, and not two numbers: as in {what}=(-90.0, 90.0)"


def described(given: object) -> str:
    """A part as a message quotes it."""
    text = " ".join(repr(given).split())
    return f"{text if len(text) <= _LONGEST else text[:_LONGEST] + '…'} (a {type(given).__name__})"


_LONGEST = 40
