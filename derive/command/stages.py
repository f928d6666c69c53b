"""The lines of a run about one machine: one for every stage, and what it is doing while it takes long."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import FrameType, TracebackType
from typing import TextIO

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


_LOADING = "derive.description.catalogue", "_executed"
"""The function that runs a description's file."""
_WORDS = {
    "derive.drawing": "drawing",
    "derive.emit.c": "writing C",
    "derive.emit.javascript": "writing JavaScript",
    "derive.emit.linuxcnc": "writing a module for LinuxCNC",
    "derive.emit.page": "writing the page",
    "derive.emit.picture": "drawing",
    "derive.emit.python": "writing Python",
    "derive.emit.softmotion": "writing Structured Text",
    "derive.equations": "stating the equations",
    "derive.kinematics": "building the programs",
    "derive.lowering": "saving operations",
    "derive.report": "making its self-test",
    "derive.solver": "solving its equations",
    "derive.witness": "measuring it against its equations",
}
"""The folders of the compiler that take long."""


def doing() -> str:
    """What the main thread is doing; "" where that has no words."""
    frame = sys._current_frames().get(threading.main_thread().ident or 0)
    frames = list(_outwards(frame))
    return _in_description(frames) or next((word for f in frames if (word := _word(_module(f)))), "")


def _in_description(frames: list[FrameType]) -> str:
    """The line of the description that is being run; "" where none is."""
    place = next((i for i, f in enumerate(frames) if (_module(f), f.f_code.co_name) == _LOADING), 0)
    inside = [f for f in frames[:place] if not f.f_code.co_filename.startswith("<frozen ")]
    own = [f for f in inside if f.f_code.co_filename == inside[-1].f_code.co_filename]
    return f"still running the description: line {own[0].f_lineno} of {Path(own[0].f_code.co_filename)}" if own else ""


def _word(module: str) -> str | None:
    return next((word for name, word in _WORDS.items() if f"{module}.".startswith(f"{name}.")), None)


def _module(frame: FrameType) -> str:
    return str(frame.f_globals.get("__name__", ""))


def _outwards(frame: FrameType | None) -> Iterator[FrameType]:
    """The frames of a stack, the innermost first."""
    while frame is not None:
        yield frame
        frame = frame.f_back
