"""The types of arguments and results of the standard functions of the language."""

from collections.abc import Callable

from . import ast
from . import st_types as types
from .conversions import common, conversion, fits
from .faults import StError
from .lexical import QUERY

REAL_FUNCTIONS = {"SQRT", "SIN", "COS", "ATAN"}
_COUNTS = {"ABS": (1, 1), "TRUNC": (1, 1), "MIN": (2, 9), "MAX": (2, 9), "SEL": (3, 3), "LIMIT": (3, 3), "LEFT": (2, 2)}


def is_builtin(name: str) -> bool:
    upper = name.upper()
    return upper in REAL_FUNCTIONS or upper in _COUNTS or upper in ("SIZEOF", QUERY) or conversion(upper) is not None


def result_type(node: ast.Call, name: str, type_of: Callable[[ast.Expression], types.Type]) -> types.Type:
    """The type a call of a builtin gives; `type_of` checks an argument."""
    upper = name.upper()
    low, high = _COUNTS.get(upper, (1, 1))
    if not low <= len(node.arguments) <= high:
        raise StError(node.at, f"wrong number of arguments for {name}")
    if any(argument.name is not None for argument in node.arguments):
        raise StError(node.at, f"{name} takes no named arguments")
    given = [type_of(argument.value) for argument in node.arguments]
    found = _result(upper, given)
    if found is None:
        raise StError(node.at, f"{name} does not take {', '.join(t.name for t in given)}")
    return found


def _result(name: str, given: list[types.Type]) -> types.Type | None:
    if name in REAL_FUNCTIONS:
        return types.LREAL if fits(given[0], types.LREAL) else None
    if name == "TRUNC":
        return types.DINT if given[0] == types.LREAL else None
    if name == "ABS":
        return given[0] if _is_number(given[0]) else None
    if name in ("MIN", "MAX", "LIMIT"):
        met = _meet(given)
        return met if met is not None and _is_number(met) else None
    if name == "LEFT":
        length = given[1].value if isinstance(given[1], types.IntegerLiteral) else -1
        return types.String(length) if isinstance(given[0], types.String) and length >= 0 else None
    if name == "SEL":
        met = _meet(given[1:])
        return met if given[0] == types.BOOL and met is not None and types.is_scalar(met) else None
    pair = conversion(name)
    return pair[1] if pair is not None and fits(given[0], pair[0]) else None


def _is_number(of: types.Type) -> bool:
    return of == types.LREAL or (isinstance(of, types.Integer) and not of.is_bits)


def _meet(given: list[types.Type]) -> types.Type | None:
    met: types.Type | None = given[0]
    for other in given[1:]:
        met = None if met is None else common(met, other)
    return met
