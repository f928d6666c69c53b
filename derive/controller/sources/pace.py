"""So many times a second: a source that is late does not hurry to catch up."""

from __future__ import annotations

import asyncio


class Pace:
    """The moments at which something is done."""

    def __init__(self, rate: float) -> None:
        """rate: how many times a second."""
        self._interval = 1.0 / rate
        self._due = asyncio.get_running_loop().time()

    async def next(self) -> None:
        """Wait for the next moment; those that have passed are left out."""
        now = asyncio.get_running_loop().time()
        self._due = max(self._due + self._interval, now)
        await asyncio.sleep(self._due - now)
