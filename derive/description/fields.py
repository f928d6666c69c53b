"""The kinds of values that the fields and parts of a mechanism hold: the message about any other kind says which was
expected, and a forgotten comma gets a message of its own.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from numbers import Real
from typing import Any

import sympy as sp

from derive.description.errors import DescriptionError

_MANY: Mapping[str, tuple[str, str]] = {
    "joints": ("Joint", "(A1, A2)"),
    "parameters": ("Parameter", "(L1, L2)"),
    "rods": ("Rod", '(rod("1", KNEE, TOOL, LENGTH),)'),
    "guides": ("Plane", '(guide("1", (0, 1, 0), on_plate(R, 0, 0)),)'),
    "bars": ("Rod", '(rod("1", KNEE, TOOL, LENGTH),)'),
    "bounds": ("Bound", "(bound(…),)"),
    "branches": ("Branch", '(branch("elbow", sin(A2), right=+1, left=-1),)'),
    "held": ("Joint", "(E1,)"),
    "surplus": ("Joint", "(L4,)"),
    "drives": ("Drive", "(driven(A2, by=S2, start=Tx(D), tip=Ry(A2) * Tx(L)),)"),
    "limited": ("Limited", "(limited(…),)"),
    "constraints": ("Constraint", "(Constraint(L1 < L2, …),)"),
    "aliases": ("str", '("AnotherName",)'),
    "notes": ("str", '("A sentence.",)'),
    "periods": ("str", '("A4", "A1")'),
    "closure": ("", "(X - A1, Y - A2)"),
    "positive": ("", "(R,)"),
    "home": ("", "(0, 0, 0)"),
    "load": ("", "(0, 0, -1)"),
}
"""Fields that hold several values: the class of a value (none: an expression), and an example."""
_ONE: Mapping[str, tuple[tuple[str, ...], str]] = {
    "name": (("str",), '"MyMachine"'),
    "task": (("Task",), 'Task("xyz")'),
    "vendor": (("Vendor", "NoneType"), "Vendor.TEXTBOOK"),
    "family": (("str",), '"own"'),
    "source": (("str",), '"a book"'),
    "summary": (("str",), '"A sentence."'),
    "chain": (("Chain", "NoneType"), "Rz(A1) * Tx(L1)"),
    "belt": (("str", "NoneType"), '"H"'),
    "assembly": (("Assembly", "NoneType"), 'assembly("tool", …)'),
    "search": (("Search", "NoneType"), "search(A6, where=OFFSET)"),
    "title": (("str", "NoneType"), '"My machine"'),
    "class_name": (("str", "NoneType"), '"MyMachine"'),
    "offset_interface": (("bool", "NoneType"), "False"),
}
"""Fields that hold one value: its classes, and an example."""
_MAY_BE_NONE = ("periods",)


def as_stated(values: Mapping[str, Any]) -> dict[str, Any]:
    """The fields with tuples for lists. Raises `DescriptionError` for a value of the wrong kind."""
    found: dict[str, Any] = {}
    for name, (kinds, example) in _ONE.items():
        if not _is(values[name], kinds):
            raise DescriptionError(f"{name} must not be {_what(values[name])}: as in {name}={example}")
    for name, (kind, example) in _MANY.items():
        value = values[name]
        if value is None and name in _MAY_BE_NONE:
            continue
        if not isinstance(value, tuple | list):
            more = ": a comma makes the tuple" if _is(value, (kind,)) else ""
            raise DescriptionError(f"{name} must be a tuple, not {_what(value)}{more}, as in {name}={example}")
        found[name] = tuple(_flat(value))
        for one in found[name]:
            if kind and not _is(one, (kind,)):
                raise DescriptionError(f"{name} must not hold {_what(one)}: as in {name}={example}")
    return found


def _flat(values: Iterable[Any]) -> Iterator[Any]:
    """The values, and those of a tuple or list among them: a comma too many makes one."""
    for one in values:
        if isinstance(one, tuple | list):
            yield from _flat(one)
        else:
            yield one


def is_field(name: str) -> bool:
    """Whether this is a field of a mechanism."""
    return name in _ONE or name in _MANY


def _is(value: object, kinds: tuple[str, ...]) -> bool:
    """Whether a value has one of the classes, compared by name: their modules import this one."""
    return any(base.__name__ in kinds for base in type(value).__mro__)


def _what(value: object) -> str:
    return repr(value) if isinstance(value, str | int | float | None) else f"a {type(value).__name__}"


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
