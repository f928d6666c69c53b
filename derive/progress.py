"""The output of a run while it works: a line for every mechanism, on a terminal a bar with the remaining time, and what
takes long.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TextIO

_WIDTH = 24
_SILENCE = 10.0
"""Seconds without a line after which a run that writes no terminal says what it does; then after twice as many, etc."""
_TICK = 1.0
"""Seconds between two states of the line that runs on a terminal."""


class Patience:
    """Lines, between which a thread says what is going on: on a terminal every second, in a line that the next one
    replaces; elsewhere in a plain line, ever more rarely.
    """

    def __init__(self, stream: TextIO, text: Callable[[], str], clock: Callable[[], float] = time.monotonic) -> None:
        """text: what is going on."""
        self._stream, self._text, self._clock = stream, text, clock
        self._is_terminal = stream.isatty()
        self._lock, self._ended = threading.Lock(), threading.Event()
        self._last, self._silence = clock(), _SILENCE

    def begin(self) -> None:
        """Start the thread; it ends with the program, if nothing ends it before."""
        threading.Thread(target=self._run, daemon=True).start()

    def end(self) -> None:
        """End the thread, and remove the line that runs."""
        self._ended.set()
        self.line("", is_whole=False)

    def line(self, text: str, *, is_whole: bool = True) -> None:
        """Print a line in place of the one that runs; one that is not whole is replaced by the next."""
        with self._lock:
            self._last, self._silence = self._clock(), _SILENCE
            self._write(f"{text}\n" if is_whole else text)

    def look(self) -> None:
        """Say what is going on, if it is time."""
        with self._lock:
            if self._ended.is_set():
                return
            if self._is_terminal:
                self._write(self._text())
            elif self._clock() - self._last >= self._silence:
                self._silence *= 2
                self._write(f"{self._text()}\n")

    def _run(self) -> None:
        while not self._ended.wait(_TICK):
            self.look()

    def _write(self, text: str) -> None:
        self._stream.write(f"\r\033[K{text}" if self._is_terminal else text)
        self._stream.flush()


class Progress:
    """A line for every piece of work; `total` pieces take time."""

    def __init__(self, total: int, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        """The clock gives seconds."""
        self._total, self._clock = total, clock
        self._done, self._start = 0, clock()
        self._patience = Patience(stream, self.bar, clock)
        self._is_terminal = stream.isatty()
        if total:
            self._patience.begin()
        self._show()

    def step(self, line: str, took_time: bool) -> None:
        """Note that a piece of work is done: print its line, and the bar again."""
        self._done += took_time
        self._patience.line(line)
        self._show()

    def end(self) -> None:
        """Remove the bar."""
        self._patience.end()

    def bar(self) -> str:
        """The share that is done, the time that it took, and the remaining time at this pace."""
        full = round(_WIDTH * self._done / self._total) if self._total else _WIDTH
        took = self._clock() - self._start
        text = f"[{'#' * full}{'.' * (_WIDTH - full)}] {self._done} of {self._total}, {took:.0f} s"
        if self._done:
            text += f", about {took / self._done * (self._total - self._done):.0f} s left"
        return text

    def _show(self) -> None:
        if self._is_terminal and self._done < self._total:
            self._patience.line(self.bar(), is_whole=False)
