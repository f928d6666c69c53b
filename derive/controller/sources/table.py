"""A CSV file, replayed: a column with the time in seconds, and one for each axis."""

from __future__ import annotations

import asyncio
import csv
import io
import math
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from derive.controller.channels import Channel
from derive.controller.feed import Feed
from derive.controller.reading import Unusable
from derive.controller.refusal import Refused

TIME_NAMES = ("time", "t")
"""The names of the time column, where none is given."""
_DELIMITERS = ";\t,"


@dataclass(frozen=True)
class Recording:
    """The content of a table."""

    times: tuple[float, ...]
    """Seconds, ascending."""
    rows: tuple[dict[str, object], ...]
    """The answers about each axis at each of these times."""


@dataclass(frozen=True)
class Replay:
    """A recording, and its speed."""

    recording: Recording
    speed: float
    is_loop: bool
    rate: float
    """Updates a second; rows that follow one another faster are left out."""

    async def run(self, feed: Feed) -> None:
        """Give each row at its time, and start again at the end where it is a loop."""
        clock = asyncio.get_running_loop().time
        times, rows = self.recording.times, self.recording.rows
        shortest = 0.25 / self.rate
        while True:
            start, at = clock(), 0
            while at < len(times):
                feed.take(rows[at], times[at])
                passed = times[0] + (clock() + shortest - start) * self.speed
                at = max(at + 1, bisect_right(times, passed) - 1)
                if at < len(times):
                    await asyncio.sleep(max(start + (times[at] - times[0]) / self.speed - clock(), shortest))
            if not self.is_loop:
                return
            await asyncio.sleep(shortest)


def recording_of(path: Path, channels: Sequence[Channel], time: Channel | None) -> Recording:
    """The recording in a file; raises `Refused` with the line that is wrong.

    A column is named by its heading, or by its number from 1 on. Cells are separated by `;`, tab, or `,`; where it is
    not `,`, a number may have a decimal comma.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as problem:
        raise Refused(f"{path}: {getattr(problem, 'strerror', None) or problem}") from None
    first = text.partition("\n")[0]
    delimiter = next((d for d in _DELIMITERS if d in first), ",")
    lines = [line for line in csv.reader(io.StringIO(text), delimiter=delimiter) if line]
    if not lines:
        raise Refused(f"{path}: there is no row of values")
    headings = [cell.strip() for cell in lines[0]]
    clock = time or Channel("time", next((n for n in TIME_NAMES if n in [h.lower() for h in headings]), "1"))
    at = _column(clock.node, headings, path)
    columns = {channel.axis: _column(channel.node, headings, path) for channel in channels}
    body = lines[0 if all(_is_number(cell, delimiter) for cell in headings) else 1 :]
    times: list[float] = []
    for number, row in enumerate(body, len(lines) - len(body) + 1):
        now = _cell(row, at, delimiter)
        if not isinstance(now, float) or not math.isfinite(now) or (times and now * clock.scale < times[-1]):
            raise Refused(f"{path}, row {number}: the time is no number, or less than the one before")
        times.append(now * clock.scale)
    if not times:
        raise Refused(f"{path}: there is no row of values")
    rows = ({axis: _cell(row, column, delimiter) for axis, column in columns.items()} for row in body)
    return Recording(tuple(times), tuple(rows))


def _column(name: str, headings: Sequence[str], path: Path) -> int:
    """The place of a column."""
    lowered = [heading.lower() for heading in headings]
    if name.lower() in lowered:
        return lowered.index(name.lower())
    if name.isdecimal() and 1 <= int(name) <= len(headings):
        return int(name) - 1
    raise Refused(f"{path}: there is no column {name!r}: the columns are {', '.join(headings)}")


def _cell(row: Sequence[str], at: int, delimiter: str) -> object:
    text = row[at].strip() if at < len(row) else ""
    return number_of(text.replace(",", ".") if delimiter != "," else text)


def _is_number(text: str, delimiter: str) -> bool:
    return isinstance(_cell([text], 0, delimiter), float)


def number_of(text: str) -> float | Unusable:
    """The number in a text, which may be NaN or infinite."""
    try:
        return float(text)
    except ValueError:
        return Unusable(f"no number: {text[:40]!r}")
