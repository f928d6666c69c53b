"""The lines of a run about one machine: one for every stage; on a terminal also the stage that is under way."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TextIO


class Stages:
    """The lines of one machine."""

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        """The clock gives seconds."""
        self._stream, self._clock, self._start = stream, clock, clock()
        self._is_terminal = stream.isatty()

    def told(self, stage: str, found: str) -> None:
        """Note that a stage has begun (`found` is then empty), or has ended."""
        if not found:
            self._start = self._clock()
            self._write(f"  {stage:8} …" if self._is_terminal else "")
            return
        seconds = self._clock() - self._start
        self._write(f"{self._cleared()}  {stage:8} {seconds:5.1f} s   {found}\n")

    def line(self, text: str) -> None:
        """Print a separate line, in place of the stage that is under way."""
        self._write(f"{self._cleared()}{text}\n")

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()

    def _cleared(self) -> str:
        return "\r\033[K" if self._is_terminal else ""
