"""The runtime of translated text: references, memory, and arithmetic that faults as on a controller."""

from __future__ import annotations

import math
from typing import Any, NoReturn

from .faults import StFault

LOOP_CAP = 1_000_000


# ---- references ----------------------------------------------------------------------------
class Cell:
    """A scalar variable that can be passed by reference."""

    __slots__ = ("value",)

    def __init__(self, value: Any) -> None:
        self.value = value


class FieldCell:
    """A scalar field of an object that is passed by reference."""

    __slots__ = ("name", "owner")

    def __init__(self, owner: Any, name: str) -> None:
        self.owner = owner
        self.name = name

    @property
    def value(self) -> Any:
        return getattr(self.owner, self.name)

    @value.setter
    def value(self, value: Any) -> None:
        setattr(self.owner, self.name, value)


class ElementCell:
    """A scalar element of an array that is passed by reference."""

    __slots__ = ("elements", "index")

    def __init__(self, elements: list[Any], index: int) -> None:
        self.elements = elements
        self.index = index

    @property
    def value(self) -> Any:
        return self.elements[self.index]

    @value.setter
    def value(self, value: Any) -> None:
        self.elements[self.index] = value


class Pointer:
    """A view of memory: the first `count` LREALs of it exist."""

    __slots__ = ("count", "memory")

    def __init__(self, memory: list[float], count: int) -> None:
        self.memory = memory
        self.count = count


def peek(pointer: Pointer | None, offset: int) -> float:
    if pointer is None:
        raise StFault("null pointer dereferenced")
    if offset >= pointer.count:
        raise StFault(f"read beyond the memory of a pointer: element {offset} of {pointer.count}")
    return pointer.memory[offset]


def poke(pointer: Pointer | None, offset: int, value: float) -> None:
    if pointer is None:
        raise StFault("null pointer dereferenced")
    if offset >= pointer.count:
        raise StFault(f"write beyond the memory of a pointer: element {offset} of {pointer.count}")
    pointer.memory[offset] = value


# ---- values of declared types --------------------------------------------------------------
class StructValue:
    """Base of all structures. Translated classes bring the fields, `_assign` and `_copy`."""

    __slots__ = ()
    _fields: tuple[str, ...] = ()

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and all(getattr(self, name) == getattr(other, name) for name in self._fields)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{n}={getattr(self, n)!r}' for n in self._fields)})"


class Matrix(StructValue):
    """The opaque rotation matrix: memory only. Nine numbers, or more where the stub is larger."""

    __slots__ = ("memory",)
    _fields = ("memory",)
    size = 72

    def __init__(self) -> None:
        self.memory = [0.0] * max(9, self.size // 8)

    def _assign(self, other: Matrix) -> None:
        self.memory[:] = other.memory

    def _copy(self) -> Matrix:
        new = object.__new__(type(self))
        new.memory = self.memory[:]
        return new


def address(operand: Any) -> Pointer:
    if isinstance(operand, Matrix):
        return Pointer(operand.memory, operand.size // 8)
    return Pointer(operand, len(operand))


def assign_elements(target: list[Any], source: list[Any]) -> None:
    for own, other in zip(target, source, strict=True):
        own._assign(other)


def copy_elements(source: list[Any]) -> list[Any]:
    return [element._copy() for element in source]


# ---- faults --------------------------------------------------------------------------------
def not_finite(value: float) -> NoReturn:
    raise StFault(f"real result {value} is not finite")


def overflow(value: int) -> NoReturn:
    raise StFault(f"integer overflow: {value}")


def unbounded() -> NoReturn:
    raise StFault(f"loop runs more than {LOOP_CAP} times")


def outside(index: int, low: int, high: int) -> NoReturn:
    raise StFault(f"array index {index} outside {low}..{high}")


# ---- arithmetic ----------------------------------------------------------------------------
def quotient(left: int, right: int) -> int:
    """Integer division cuts towards zero."""
    if right == 0:
        raise StFault("division by zero")
    if left >= 0 and right > 0:
        return left // right
    found = abs(left) // abs(right)
    return found if (left < 0) == (right < 0) else -found


def remainder(left: int, right: int) -> int:
    """MOD has the sign of the dividend."""
    if left >= 0 and right > 0:
        return left % right
    return left - right * quotient(left, right)


def rounded(value: float) -> int:
    """LREAL_TO_…: to the nearest integer, halves away from zero."""
    if not math.isfinite(value):
        raise StFault(f"conversion of {value} to an integer")
    whole = math.floor(abs(value))
    whole += abs(value) - whole >= 0.5
    return whole if value >= 0 else -whole


def truncated(value: float) -> int:
    if not math.isfinite(value):
        raise StFault(f"conversion of {value} to an integer")
    return math.trunc(value)


def limited(low: Any, value: Any, high: Any) -> Any:
    return maximum(low, minimum(value, high))


def left(text: str, length: int) -> str:
    return text[:length]


def minimum(first: Any, second: Any, *others: Any) -> Any:
    if first != first or second != second:
        _refuse_nan()
    least = second if second < first else first
    return minimum(least, *others) if others else least


def maximum(first: Any, second: Any, *others: Any) -> Any:
    if first != first or second != second:
        _refuse_nan()
    largest = second if second > first else first
    return maximum(largest, *others) if others else largest


def _refuse_nan() -> NoReturn:
    """Whether MIN and MAX pass a NaN on depends on the controller, so nobody may rely on it."""
    raise StFault("MIN, MAX or LIMIT of a value that is not finite")


def selected(choice: bool, if_false: Any, if_true: Any) -> Any:
    return if_true if choice else if_false


# ---- references to interfaces --------------------------------------------------------------
def referred(instance: Any) -> Any:
    if instance is None:
        raise StFault("a call through an interface that refers to nothing")
    return instance


def query(source: Any, target: Any, name: str) -> bool:
    """Let the target refer to the instance where it implements the interface of that name, else to nothing."""
    is_found = source is not None and name in source.implemented
    target.value = source if is_found else None
    return is_found


ENVIRONMENT: dict[str, Any] = {
    item.__name__: item
    for item in (
        Cell, FieldCell, ElementCell, StructValue, peek, poke, address, assign_elements, copy_elements, not_finite,
        overflow, unbounded, outside, quotient, remainder, rounded, truncated, left, limited, minimum, maximum,
        selected, referred, query,
    )
} | {"math": math}  # fmt: skip
