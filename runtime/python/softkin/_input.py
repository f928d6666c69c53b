"""Input: the arguments of a caller become floats and ints, or an error says what is wrong with them."""

from __future__ import annotations

import sys
from array import array
from collections.abc import Iterable, Mapping, Set, Sized
from math import isnan, nan
from typing import Any

from softkin._constants import LARGEST
from softkin._types import (
    FrameLike,
    KinematicsError,
    Numbers,
    Parameter,
    Rotation,
    RotationLike,
    Status,
    Vector,
)

_LAST_ROW = (0.0, 0.0, 0.0, 1.0)
_ROUNDED = 1e-9
"""The last row of a matrix (4, 4) may differ by this."""
_TAKES_ANY = 0x0C
"""The flags of a function that takes any number of arguments, or any keyword."""


def reals(values: Numbers, count: int, what: str) -> tuple[float, ...]:
    """A tuple of `count` floats. Text is refused, although `float` would accept it."""
    if type(values) is not tuple and type(values) is not list:  # in nearly every call it is one of them
        refuse_strange(values, f"{what} must be {count} numbers")
    try:
        found = tuple(array("d", iter(values)))
    except (TypeError, ValueError, OverflowError) as error:
        raise _bad(f"{what} must be {count} numbers, not {_shown(values)}") from error
    if len(found) != count:
        raise _bad(f"{what} must be {count} numbers, not {len(found)}")
    return found


def refuse_strange(values: object, needed: str) -> None:
    """Refuse what has numbers, but not in an order that counts (sets, mappings), bytes, and arrays with a mask or of
    complex numbers."""
    if type(values) is tuple or type(values) is list:
        return
    masked = sys.modules.get("numpy.ma")  # where it is not loaded, nobody has an array with a mask
    if masked is not None and isinstance(values, masked.MaskedArray):
        raise _bad(f"{needed}, not an array with a mask: fill it, or leave its rows out")
    if getattr(getattr(values, "dtype", None), "kind", None) == "c":
        raise _bad(f"{needed}, not complex ones")
    if isinstance(values, Set | Mapping | bytes | bytearray):
        raise _bad(f"{needed} in a sequence, not {type(values).__name__}: {_shown(values)}")


def pose_of(frame: FrameLike) -> tuple[Vector, Rotation]:
    """Position and rotation of a frame. Tuples of plain floats are taken as they are, which is faster."""
    position, rows = _halves(frame)
    if type(position) is tuple and type(rows) is tuple and len(position) == len(rows) == 3:
        first, second, third = rows
        if (
            type(first) is tuple
            and type(second) is tuple
            and type(third) is tuple
            and len(first) == len(second) == len(third) == 3
        ):
            (x, y, z), (a, b, c), (d, e, f), (g, h, i) = position, first, second, third
            if (
                type(x) is type(y) is type(z) is type(a) is type(b) is type(c) is float
                and type(d) is type(e) is type(f) is type(g) is type(h) is type(i) is float
            ):
                return (x, y, z), ((a, b, c), (d, e, f), (g, h, i))
    return position_of(frame), rotation_of(frame)


def position_of(frame: FrameLike) -> Vector:
    """The position of a frame."""
    position, _ = _halves(frame)
    x, y, z = reals(position, 3, "position")
    return x, y, z


def rotation_of(frame: FrameLike) -> Rotation:
    """The rotation of a frame."""
    _, rows = _halves(frame)
    return rotation_by_rows(rows)


def matrix_of(rotation: Any) -> Any:
    """The matrix of an object that has one, as SciPy's `Rotation`; anything else as it is."""
    return rotation.as_matrix() if hasattr(rotation, "as_matrix") else rotation


def rotation_by_rows(rotation: RotationLike) -> Rotation:
    """A rotation by rows."""
    rows: Any = matrix_of(rotation)
    refuse_strange(rows, "rotation must be three rows of three numbers")
    try:
        first, second, third = rows
        for row in (first, second, third):
            refuse_strange(row, "rotation must be three rows of three numbers")
        (a, b, c), (d, e, f), (g, h, i) = first, second, third
    except (TypeError, ValueError) as error:
        raise _bad(f"rotation must be three rows of three numbers, not {_shown(rows)}") from error
    a, b, c, d, e, f, g, h, i = reals((a, b, c, d, e, f, g, h, i), 9, "rotation")
    return (a, b, c), (d, e, f), (g, h, i)


def bytes_of(configuration: Iterable[int], count: int) -> tuple[int, ...]:
    """A tuple of `count` signed bytes, where 128 to 255 stand for the negative ones."""
    if type(configuration) is tuple and len(configuration) == count:
        try:
            plain = bytes(configuration)
        except (TypeError, ValueError):
            plain = b"\x80"  # then each number is tested below
        if plain.isascii():
            return tuple(plain)
    try:
        found = tuple(array("h", iter(configuration)))
    except (TypeError, OverflowError) as error:
        raise _bad(f"configuration must be {count} bytes, not {_shown(configuration)}") from error
    if len(found) != count:
        raise _bad(f"configuration must be {count} bytes, not {len(found)}")
    if found and not (min(found) >= -128 and max(found) <= 127):
        if min(found) < -128 or max(found) > 255:
            raise _bad(f"configuration must be bytes, -128 to 255, not {found}")
        return tuple(n - 256 if n > 127 else n for n in found)
    return found


def parameter_value(mechanism: str, parameter: Parameter, value: float) -> float:
    """The value of a parameter in its type. NaN, and a flag that is neither 0 nor 1, raise an error; the range is
    tested later.
    """
    try:
        (number,) = array("d", (value,))
    except (TypeError, OverflowError):
        number = nan
    if number in (0.0, 1.0) or (parameter.kind != "flag" and not isnan(number)):
        return _typed(parameter, number)
    message = f"{mechanism}: {parameter.name} = {value!r} is not allowed: it must be {parameter.range}"
    raise KinematicsError(Status.NOT_INITIALIZED, message)


def _typed(parameter: Parameter, number: float) -> float:
    """A flag as bool, a direction as int. A direction that is no whole number stays as it is, and is refused later."""
    if parameter.kind == "flag":
        return bool(number)
    return int(number) if parameter.kind == "sign" and number.is_integer() else number


def unusable(inputs: dict[str, object]) -> str:
    """A sentence on the first invalid number among inputs; empty if all are valid."""
    for what, value in inputs.items():
        for name, number in _named(what, value):
            if not abs(number) <= LARGEST:
                return f"{name} is {number!r}"
    return ""


def keywords_of(function: Any) -> Set[str]:
    """The keywords of a method that takes nothing else, in their order; empty if it does."""
    code = getattr(function, "__code__", None)
    if code is None or code.co_argcount != 1 or code.co_flags & _TAKES_ANY:
        return frozenset()
    return dict.fromkeys(code.co_varnames[1 : 1 + code.co_kwonlyargcount]).keys()


def refuse_strange_keywords(name: str, known: Set[str], places: Sized, given: Mapping[str, object]) -> None:
    """Raise TypeError for a value without a name, and for a name that is not known. known: empty if all are allowed."""
    if places and known:
        raise TypeError(f"{name}: give each parameter by its name, as {name}({next(iter(known))}=…)")
    if known and not given.keys() <= known:
        strange = next(one for one in given if one not in known)
        raise TypeError(f"{name} has no parameter {strange!r}: {suggestion(strange, known, 'parameters')}")


def suggestion(word: str, known: Iterable[str], what: str = "names") -> str:
    """The known name that was perhaps meant, or all of them."""
    from difflib import get_close_matches  # nothing else needs it

    names = list(known)
    near = get_close_matches(word.lower(), names, 1, 0.5)
    return f"did you mean {near[0]!r}?" if near else f"the {what} are {', '.join(names)}"


def _named(what: str, value: object) -> Iterable[tuple[str, float]]:
    if isinstance(value, tuple):
        for i, part in enumerate(value):
            yield from _named(f"{what}[{i}]", part)
    elif isinstance(value, float):
        yield what, value


def _halves(frame: FrameLike) -> tuple[Any, Any]:
    """The position and the rotation of a pair, or of a matrix (4, 4)."""
    if isinstance(frame, tuple) and len(frame) == 2:
        return frame
    refuse_strange(frame, "a frame must be a pair of position and rotation, or a matrix (4, 4)")
    try:
        parts: tuple[Any, ...] = tuple(frame)  # type: ignore[arg-type]
        if len(parts) == 2:
            return parts[0], parts[1]
        (a, b, c, x), (d, e, f, y), (g, h, i, z), last = parts
    except (TypeError, ValueError) as error:
        raise _bad(
            f"a frame must be a pair of position and rotation, or a matrix (4, 4), not {_shown(frame)}"
        ) from error
    if not all(
        abs(given - needed) <= _ROUNDED for given, needed in zip(reals(last, 4, "last row"), _LAST_ROW, strict=True)
    ):
        raise _bad(f"the last row of a frame's matrix must be 0 0 0 1, not {_shown(last)}")
    return (x, y, z), ((a, b, c), (d, e, f), (g, h, i))


def _bad(message: str) -> KinematicsError:
    return KinematicsError(Status.BAD_INPUT, message)


def _shown(value: object) -> str:
    """A value as text for a message, on one line of limited length."""
    text = " ".join(repr(value).split())
    return text if len(text) <= 80 else f"{text[:77]}..."
