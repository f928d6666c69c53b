"""The slots of the inverse, each of which is created when it is read."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, TypeAlias, overload

from softkin._configuration import Slot
from softkin._types import Diagnosis, Reals, Solution

_Make: TypeAlias = Callable[[Slot, Any], Solution]


class Solutions(Sequence[Solution]):
    """An immutable sequence that equals the tuple of its solutions, and prints like it."""

    __slots__ = ("_found", "_make", "_slots")

    def __init__(self, found: tuple[Reals | int | Diagnosis, ...], slots: tuple[Slot, ...], make: _Make) -> None:
        """found: the axes of each slot, or the number of its status, or the reason; make: creates the solution."""
        self._found, self._slots, self._make = found, slots, make

    def __len__(self) -> int:
        """The number of slots."""
        return len(self._found)

    @overload
    def __getitem__(self, index: int) -> Solution: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Solution, ...]: ...

    def __getitem__(self, index: int | slice) -> Solution | tuple[Solution, ...]:
        """A slot, or a tuple of several slots."""
        if isinstance(index, slice):
            return tuple(self)[index]
        return self._make(self._slots[index], self._found[index])

    def __iter__(self) -> Iterator[Solution]:
        """The slots in order."""
        return map(self._make, self._slots, self._found)

    def __eq__(self, other: object) -> bool:
        """Whether the other object is a tuple or a sequence of the same solutions."""
        return tuple(self) == tuple(other) if isinstance(other, tuple | Solutions) else NotImplemented

    def __hash__(self) -> int:
        """The hash of the tuple."""
        return hash(tuple(self))

    def __repr__(self) -> str:
        """The text of the tuple."""
        return repr(tuple(self))

    def __reduce__(self) -> tuple[type[tuple[Solution, ...]], tuple[list[Solution]]]:
        """Copying and pickling give the tuple."""
        return tuple, (list(self),)
