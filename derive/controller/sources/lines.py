"""Standard input, line by line: each an object or a list of JSON, or values separated by commas."""

from __future__ import annotations

import asyncio
import os
import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from derive.controller.channels import Channel
from derive.controller.feed import Feed
from derive.controller.reading import Unusable, read_json
from derive.controller.sources.table import number_of

_LONGEST = 65536
"""The largest number of bytes of a line; a longer one is no line of values, and neither is any part of it."""
_TOO_LONG = "[ of a line that is too long"
"""The text in place of such a line, which is no JSON."""


@dataclass
class Reader:
    """The values in lines. A first line of names gives the order of the values in the lines that follow."""

    channels: Sequence[Channel]
    order: list[str] | None = field(default=None, init=False)
    """The nodes in the order of the values; None until the first line of values: then that of the axes."""

    def answers(self, line: str) -> dict[str, object]:
        """The answers in a line, by the axes that it names. An unreadable line gives a bad answer for all axes."""
        text = line.strip()
        if not text:
            return {}
        if text[0] in "{[":
            return self._of_json(text)
        cells = [cell.strip() for cell in text.split(",")]
        values = [number_of(cell) for cell in cells]
        if self.order is None and all(isinstance(value, Unusable) for value in values):
            self.order = cells
            return {}
        self.order = self.order or [channel.node for channel in self.channels]
        return self._listed(values, self.order)

    def _of_json(self, text: str) -> dict[str, object]:
        try:
            given = read_json(text)
        except ValueError as problem:
            return self._unusable(f"no JSON: {problem}")
        if isinstance(given, list):
            return self._listed(given, [channel.node for channel in self.channels])
        return {channel.axis: given[channel.node] for channel in self.channels if channel.node in given}

    def _listed(self, values: Sequence[object], nodes: Sequence[str]) -> dict[str, object]:
        if len(values) != len(nodes):
            return self._unusable(f"a line of {len(values)} values, not {len(nodes)}")
        said = dict(zip(nodes, values, strict=True))
        return {channel.axis: said[channel.node] for channel in self.channels if channel.node in said}

    def _unusable(self, reason: str) -> dict[str, object]:
        return {channel.axis: Unusable(reason) for channel in self.channels}


@dataclass(frozen=True)
class Input:
    """The lines of a file descriptor, read in their own thread: an event loop cannot wait for all kinds of input."""

    channels: Sequence[Channel]
    descriptor: int

    async def run(self, feed: Feed) -> None:
        """Pass the answers of each line to the feed until the input is over."""
        loop = asyncio.get_running_loop()
        over = loop.create_future()
        reader = Reader(self.channels)

        async def take(line: str) -> None:
            answers = reader.answers(line)
            if answers:
                feed.take(answers)

        def end() -> None:
            if not over.done():
                over.set_result(None)

        def read() -> None:
            try:
                for line in _lines(self.descriptor):
                    asyncio.run_coroutine_threadsafe(take(line), loop).result()
                loop.call_soon_threadsafe(end)
            except (RuntimeError, asyncio.CancelledError):  # the loop has stopped meanwhile
                return

        threading.Thread(target=read, name="standard input", daemon=True).start()
        await over


def _lines(descriptor: int) -> Iterator[str]:
    """The lines, read without Python's own buffer: a thread that waits in it could not be abandoned."""
    kept, is_long = b"", False
    while True:
        try:
            read = os.read(descriptor, _LONGEST)
        except OSError:
            read = b""
        *lines, kept = (kept + read).split(b"\n")
        for line in lines:
            yield _TOO_LONG if is_long or len(line) > _LONGEST else line.decode("utf-8", errors="replace")
            is_long = False
        if len(kept) > _LONGEST:
            kept, is_long = b"", True
        if not read:
            if kept or is_long:
                yield _TOO_LONG if is_long else kept.decode("utf-8", errors="replace")
            return
