"""The statements of a text: those that run, and how many there are."""

from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from functools import cache
from itertools import compress
from typing import Any

from bench import counting
from derive.description.mechanism import Mechanism
from derive.report.cost import Cost
from tests.harness.faults import Place
from tests.harness.library import Library
from tests.text.units import file_of, shared_texts, text_of


class Statements:
    """The statements of some texts, and those that ran under `watched`.

    The same text may be compiled several times: a statement is where it stands in the text.
    """

    def __init__(self, files: Iterable[str], libraries: Iterable[Library]) -> None:
        self._libraries = tuple(libraries)
        self._ran = [library.flags() for library in self._libraries]
        self._numbers = _numbered(frozenset(files), self._libraries)
        self._lines = [
            [self._numbers.get(place, 0) if place else 0 for place in lib.origin.places] for lib in self._libraries
        ]
        """The number of the place that each line of a translation comes from."""

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Note every statement that runs."""
        with ExitStack() as stack:
            for library, ran in zip(self._libraries, self._ran, strict=True):
                stack.enter_context(library.watched(ran))
            yield

    def left_out(self) -> list[Place]:
        ran: set[int] = set()
        for lines, flags in zip(self._lines, self._ran, strict=True):
            ran.update(compress(lines, flags[1:]))
        left = (place for place, number in self._numbers.items() if number not in ran)
        return sorted(left, key=lambda place: (place.file, place.line))


def _numbered(files: frozenset[str], libraries: Iterable[Library]) -> dict[Place, int]:
    """A number, from 1, for every place in these files that has a statement."""
    places = (place for library in libraries for place in library.origin.places if place is not None)
    own = dict.fromkeys(place for place in places if place.file in files)
    return {place: number for number, place in enumerate(own, 1)}


@cache
def counting_units(mechanism: Mechanism | None = None) -> Library:
    """The shared functions, with the unit of a mechanism if there is one, counting."""
    own = {} if mechanism is None else {file_of(mechanism): text_of(mechanism)}
    return counting.counting_library({**shared_texts(), **own})


def counted(call: Callable[..., Any], *arguments: Any, **named: Any) -> Cost:
    """What a call did."""
    _, found = counting.counted(call, *arguments, **named)
    return Cost(**found.of_kinds())
