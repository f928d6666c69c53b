"""The output of a run while it works: a line for every mechanism, and on a terminal a bar with the remaining time."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TextIO

_WIDTH = 24


class Progress:
    """A line for every piece of work; `total` pieces take time."""

    def __init__(self, total: int, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        """The clock gives seconds."""
        self._total, self._stream, self._clock = total, stream, clock
        self._done, self._start = 0, clock()
        self._is_terminal = stream.isatty()
        self._show()

    def step(self, line: str, took_time: bool) -> None:
        """Note that a piece of work is done: print its line, and the bar again."""
        self._done += took_time
        self._stream.write(f"{self._cleared()}{line}\n")
        self._show()

    def end(self) -> None:
        """Remove the bar."""
        self._stream.write(self._cleared())
        self._stream.flush()

    def bar(self) -> str:
        """The share that is done, and the remaining time at this pace."""
        full = round(_WIDTH * self._done / self._total) if self._total else _WIDTH
        text = f"[{'#' * full}{'.' * (_WIDTH - full)}] {self._done} of {self._total}"
        if self._done:
            left = (self._clock() - self._start) / self._done * (self._total - self._done)
            text += f", about {left:.0f} s left"
        return text

    def _show(self) -> None:
        if self._is_terminal and self._done < self._total:
            self._stream.write(self.bar())
        self._stream.flush()

    def _cleared(self) -> str:
        """The characters that bring a terminal back to the begin of an empty line."""
        return "\r\033[K" if self._is_terminal else ""
