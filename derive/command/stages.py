"""The lines of a run about one machine: one for every stage, and what it is doing while it takes long."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import TracebackType
from typing import TextIO

from derive.command.doing import doing
from derive.progress import Patience


class Stages:
    """The lines of one machine; inside `with`, a thread tells what is being done where no line comes for a while."""

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        """The clock gives seconds."""
        self._stream, self._clock, self._start, self._stage = stream, clock, clock(), "read"
        self._is_terminal = stream.isatty()
        self._patience = Patience(stream, self._text, clock)

    def __enter__(self) -> Stages:
        self._patience.begin()
        return self

    def __exit__(self, *_: type[BaseException] | BaseException | TracebackType | None) -> None:
        self._patience.end()

    def report(self, stage: str, found: str) -> None:
        """Note that a stage has begun (`found` is then empty), or has ended."""
        if not found:
            self._start, self._stage = self._clock(), stage
            self._patience.line(f"  {stage:8} …" if self._is_terminal else "", is_whole=False)
            return
        seconds = self._clock() - self._start
        self._patience.line(f"  {stage:8} {seconds:5.1f} s   {found}")
        self._start, self._stage = self._clock(), "write"

    def line(self, text: str) -> None:
        """Print a separate line, in place of the stage that is under way."""
        self._patience.line(text)

    def _text(self) -> str:
        """The stage that is under way, its time, and what it is doing."""
        return f"  {self._stage:8} {self._clock() - self._start:5.0f} s … {doing()}".rstrip()
