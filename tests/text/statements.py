"""Which statements of a text were executed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from itertools import compress

from tests.harness.faults import Place
from tests.harness.library import Library


class Statements:
    """The statements of some texts, and those that ran under `watched`.

    The same text may be compiled several times: a statement is where it stands in the text.
    """

    def __init__(self, files: Iterable[str], libraries: Iterable[Library]) -> None:
        self._files = frozenset(files)
        self._libraries = tuple(libraries)
        self._ran = [library.flags() for library in self._libraries]

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Note every statement that runs."""
        with ExitStack() as stack:
            for library, ran in zip(self._libraries, self._ran, strict=True):
                stack.enter_context(library.watched(ran))
            yield

    def left_out(self) -> list[Place]:
        """Where the statements stand that did not run."""
        every: set[Place] = set()
        ran: set[Place] = set()
        for library, flags in zip(self._libraries, self._ran, strict=True):
            places = library.origin.places
            every.update(place for place in places if place is not None and place.file in self._files)
            ran.update(place for place in compress(places, flags[1:]) if place is not None)
        return sorted(every - ran, key=lambda place: (place.file, place.line))
