"""A constant rate: a source that is late does not hurry to catch up."""

from __future__ import annotations

import asyncio

ANSWER = 0.75
"""Seconds for an answer about values: a controller that is lost is noticed within one second."""


class Pace:
    """The moments at which something is done."""

    def __init__(self, rate: float) -> None:
        """rate: the number of times a second."""
        self._interval = 1.0 / rate
        self._due = asyncio.get_running_loop().time()

    async def next(self) -> None:
        """Wait for the next moment; moments that have passed are skipped."""
        now = asyncio.get_running_loop().time()
        self._due = max(self._due + self._interval, now)
        await asyncio.sleep(self._due - now)
