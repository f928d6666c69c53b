"""One message for all pages, at a limited rate; a slow page misses messages, and delays no other page."""

from __future__ import annotations

import asyncio
import time
from collections.abc import AsyncIterator

from derive.controller.feed import Feed
from derive.controller.messages import about_the_axes
from derive.controller.settings import Settings

STILL_THERE = 0.25
"""Seconds after which a message is sent although nothing has changed, because the ages of values grow."""


class Stream:
    """The newest message, and the pages that wait for the next one."""

    def __init__(self, settings: Settings, feed: Feed) -> None:
        self._settings = settings
        self._feed = feed
        self._number = 0
        self._text = ""
        self._is_over = False
        self._news = asyncio.Condition()

    async def run(self) -> None:
        """Make messages until it is cancelled: one when something has changed, and one when nothing has for a while."""
        interval = 1.0 / self._settings.rate
        due = self._feed.clock()
        while True:
            await self._feed.changed(STILL_THERE)
            await asyncio.sleep(due - self._feed.clock())
            await self._tell()
            due = max(due, self._feed.clock() - interval) + interval

    async def finish(self) -> None:
        """Send a last message to every page, and end."""
        self._is_over = True
        await self._tell()

    async def newest(self) -> AsyncIterator[str]:
        """The newest message, and then each that is the newest when it is asked for."""
        seen = 0
        while True:
            async with self._news:
                while self._number <= seen:
                    await self._news.wait()
                seen, text, is_over = self._number, self._text, self._is_over
            yield text
            if is_over:
                return

    async def _tell(self) -> None:
        self._number += 1
        self._text = about_the_axes(
            self._feed, self._settings.machine.name, self._settings.stale_after, self._number, time.time()
        )
        async with self._news:
            self._news.notify_all()
