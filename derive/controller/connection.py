"""A source whose lost connections are reported, and tried again after longer and longer waits."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Protocol

from derive.controller.feed import Feed, Status
from derive.controller.refusal import Lost, Refused

FIRST_WAIT, LONGEST_WAIT = 0.5, 15.0
"""The first and the longest wait after a loss, in seconds; each wait is twice the one before."""


class Source(Protocol):
    """Where axis values come from."""

    async def run(self, feed: Feed) -> None:
        """Read into the feed until the source is over; raises `Lost`, or `Refused` where it can never be."""


async def keep(source: Source, feed: Feed, wait: Callable[[float], Awaitable[None]] = asyncio.sleep) -> None:
    """Read until the source is over, connecting again after every loss. Raises `Refused`."""
    seconds = FIRST_WAIT
    while True:
        feed.tell(Status.CONNECTING, feed.condition.message)
        try:
            await source.run(feed)
        except Lost as problem:
            seconds = FIRST_WAIT if feed.condition.status is Status.LIVE else seconds
            feed.tell(Status.LOST, str(problem), seconds)
            await wait(seconds)
            seconds = min(2 * seconds, LONGEST_WAIT)
        except Refused as problem:
            feed.tell(Status.REFUSED, str(problem))
            raise
        else:
            feed.tell(Status.ENDED, "the values are over")
            return
