"""Which statements of a text were executed."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, contextmanager
from types import CodeType, FrameType
from typing import Any
from unittest.mock import patch

from tests.harness.faults import Place
from tests.harness.library import Library


class Statements:
    """The statements of some texts, and those that ran under `watched`.

    The same text may be compiled several times: a statement is where it stands in the text.
    """

    def __init__(self, files: Iterable[str], libraries: Iterable[Library]) -> None:
        self._files = frozenset(files)
        self._origins = {library.origin.filename: library.origin for library in libraries}
        self._lines: set[tuple[str, int]] = set()
        self._left: dict[CodeType, set[int]] = {}

    @contextmanager
    def watched(self) -> Iterator[None]:
        """Note every statement that runs."""
        with ExitStack() as stack:
            for origin in self._origins.values():
                stack.enter_context(patch.object(origin, "run", self._traced(origin.run)))
            yield

    def left_out(self) -> list[Place]:
        """Where the statements stand that did not run."""
        lines = {(file, line) for file, origin in self._origins.items() for line in range(1, len(origin.places) + 1)}
        found = {self._place(*line) for line in lines} - {self._place(*line) for line in self._lines}
        return sorted((place for place in found if place is not None), key=lambda place: (place.file, place.line))

    def _place(self, file: str, line: int) -> Place | None:
        """Where a statement of the texts stands, by its line in the translation."""
        place = self._origins[file].places[line - 1]
        return place if place is not None and place.file in self._files else None

    def _traced(self, run: Callable[..., Any]) -> Callable[..., Any]:
        """The same way into the text, with every line noted that it leads to."""

        def traced(function: Callable[..., Any], arguments: list[Any]) -> Any:
            before = sys.gettrace()
            sys.settrace(self._enter)
            try:
                return run(function, arguments)
            finally:
                sys.settrace(before)

        return traced

    def _enter(self, frame: FrameType, event: str, argument: Any) -> Any:
        """Follow a call into the texts, unless every line of it has run already."""
        code = frame.f_code
        if code.co_filename not in self._origins:
            return None
        if code not in self._left:
            lines = {line for *_, line in code.co_lines() if line is not None and self._place(code.co_filename, line)}
            self._left[code] = lines - {code.co_firstlineno}
        return self._step if self._left[code] else None

    def _step(self, frame: FrameType, event: str, argument: Any) -> Any:
        if event == "line":
            self._lines.add((frame.f_code.co_filename, frame.f_lineno))
            self._left[frame.f_code].discard(frame.f_lineno)
        return self._step
