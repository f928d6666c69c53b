"""Values of the controller's types: made from numbers, read back, and filled with arbitrary values."""

from collections.abc import Iterable, Iterator, Sequence
from functools import cache, lru_cache
from math import nan
from typing import Any

from tests.harness.library import Library
from tests.harness.runtime import StructValue

AXES = 6
"""The entries of AXISPOS_REF."""
NO_AXES = (nan,) * AXES
MEANINGLESS = -4711.5
"""What stands in a real variable before a method is called."""
MEANINGLESS_BYTE = 0xAB
AXES_TYPE, BYTES_TYPE, IMAGE_TYPE = "TRAFO.AXISPOS_REF", "TRAFO.CONFIGDATA", "TRAFO.OrientationSpace"
PROPERTIES_TYPE = "TRAFO.Axis_Properties"
FRAME_TYPE, MATRIX_TYPE, VECTOR_TYPE = "SM3M.SMC_Frame", "SM3M.SMC_Matrix3", "SM3M.SMC_Vector3D"

Numbers = Sequence[float]
Path = tuple[str | int, ...]
"""Where a scalar lies inside a value: fields and indices."""


@cache
def _first(library: Library, type_name: str) -> Any:
    return library.new(type_name)


def new(library: Library, type_name: str) -> Any:
    """A fresh value of a type."""
    return _first(library, type_name)._copy()


@cache
def _meaningless(library: Library, type_name: str) -> Any:
    return filled(new(library, type_name))


def meaningless(library: Library, type_name: str) -> Any:
    """A fresh value of a type, filled with what means nothing."""
    return _meaningless(library, type_name)._copy()


def axes(library: Library, values: Numbers) -> Any:
    """Axis values. The entries beyond them are no numbers: nobody may read them."""
    made = new(library, AXES_TYPE)
    made.a0, made.a1, made.a2, made.a3, made.a4, made.a5 = (*values, *NO_AXES[len(values) :])
    return made


def vector(library: Library, values: Numbers) -> Any:
    made = new(library, VECTOR_TYPE)
    made.dX, made.dY, made.dZ = values
    return made


def matrix(library: Library, rows: Iterable[Numbers]) -> Any:
    made = new(library, MATRIX_TYPE)
    library.set_rotation(made, tuple(rows))
    return made


def frame(library: Library, position: Numbers, rows: Iterable[Numbers]) -> Any:
    made = new(library, FRAME_TYPE)
    made.vT.dX, made.vT.dY, made.vT.dZ = position
    library.set_rotation(made.mR, tuple(rows))
    return made


def configuration(library: Library, values: Iterable[int]) -> Any:
    """Configuration bytes, signed or not. The bytes beyond them are not zero: nobody may read them."""
    return _configuration(library, tuple(values))._copy()


@lru_cache(maxsize=2000)
def _configuration(library: Library, values: tuple[int, ...]) -> Any:
    made = new(library, BYTES_TYPE)
    given = [value % 256 for value in values]
    made.abyData[:] = given + [MEANINGLESS_BYTE] * (len(made.abyData) - len(given))
    return made


def axes_of(value: Any) -> tuple[float, ...]:
    return value.a0, value.a1, value.a2, value.a3, value.a4, value.a5


def vector_of(value: Any) -> tuple[float, ...]:
    return value.dX, value.dY, value.dZ


def filled(value: Any) -> Any:
    """The same value with nothing but what means nothing in it."""
    for path in scalars(value):
        found = element(value, path)
        if isinstance(found, float):
            put(value, path, MEANINGLESS)
        elif isinstance(found, int) and not isinstance(found, bool):
            put(value, path, MEANINGLESS_BYTE)
        elif path[-1:] == ("dof",):
            put(value, path, "three")
    return value


def plain(value: Any) -> Any:
    """What a value holds, to be compared later."""
    return {path: element(value, path) for path in scalars(value)}


def scalars(value: Any) -> tuple[Path, ...]:
    """Where every scalar of a value lies: in all structures of a type at the same places."""
    return _places(type(value)) if isinstance(value, StructValue) else tuple(_found(value))


@cache
def _places(made: type[StructValue]) -> tuple[Path, ...]:
    return tuple(_found(made()))


def _found(value: Any) -> Iterator[Path]:
    if isinstance(value, StructValue):
        for name in value._fields:
            yield from ((name, *rest) for rest in _found(getattr(value, name)))
    elif isinstance(value, list):
        for index, part in enumerate(value):
            yield from ((index, *rest) for rest in _found(part))
    else:
        yield ()


def copied(value: Any) -> Any:
    """The same value at another place in memory."""
    if isinstance(value, StructValue):
        return value._copy()
    return list(map(copied, value)) if isinstance(value, list) else value


def element(value: Any, path: Path) -> Any:
    """The scalar at a path."""
    for step in path:
        value = getattr(value, step) if isinstance(step, str) else value[step]
    return value


def put(value: Any, path: Path, scalar: Any) -> None:
    *outer, last = path
    owner = element(value, tuple(outer))
    if isinstance(last, str):
        setattr(owner, last, scalar)
    else:
        owner[last] = scalar
