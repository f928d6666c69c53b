"""A source whose lost connections are reported, and tried again."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Protocol

from derive.controller.feed import Feed, Status
from derive.controller.refusal import Lost, Refused

WAIT = 1.0
"""Seconds from a loss to the next try: a controller that is back is found within three."""


class Source(Protocol):
    """Where axis values come from."""

    async def run(self, feed: Feed) -> None:
        """Read into the feed until the source is over; raises `Lost`, or `Refused` where it can never be."""


async def keep(source: Source, feed: Feed, wait: Callable[[float], Awaitable[None]] = asyncio.sleep) -> None:
    """Read until the source is over, connecting again after every loss. Raises `Refused`."""
    while True:
        feed.tell(Status.CONNECTING, feed.condition.message)
        try:
            await source.run(feed)
        except Lost as problem:
            feed.tell(Status.LOST, str(problem), WAIT)
            await wait(WAIT)
        except Refused as problem:
            feed.tell(Status.REFUSED, str(problem))
            raise
        else:
            feed.tell(Status.ENDED, "the values are over")
            return
