"""The newest reading of each axis, and the state of the connection: sources write them, and messages hold them."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum

from derive.controller.channels import Channel
from derive.controller.reading import Reading, judged
from derive.description.errors import printable


class Status(Enum):
    """The state of the connection to the source."""

    CONNECTING = "connecting"
    LIVE = "live"
    LOST = "lost"
    """No answer; the connection is tried again."""
    ENDED = "ended"
    """The table or the input is over."""
    REFUSED = "refused"
    """The connection is impossible and not tried again: a wrong password, a certificate that is not trusted."""


@dataclass(frozen=True)
class Condition:
    """The status, and a message about it for a person."""

    status: Status
    message: str = ""
    retry_at: float | None = None
    """The time of the next try, in seconds of the clock of the feed."""


class Feed:
    """The present state of the machine: the one object that changes while values come in."""

    def __init__(
        self,
        channels: tuple[Channel, ...],
        hear: Callable[[Condition], None] = lambda _: None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """hear: gets each new condition; clock: seconds that never go back."""
        self.channels = channels
        self.clock = clock
        self.readings: dict[str, Reading] = {}
        """The readings by axis; an axis without an answer is missing."""
        self.recorded: float | None = None
        """The time that the source itself gives, in seconds: that of a table."""
        self.condition = Condition(Status.CONNECTING)
        self._hear = hear
        self._changed = asyncio.Event()

    def take(self, answers: Mapping[str, object], recorded: float | None = None) -> None:
        """Note answers by axis: numbers, `Unusable`, or anything else, which is no number. The source is live."""
        now = self.clock()
        scales = {channel.axis: channel.scale for channel in self.channels}
        self.readings.update({axis: judged(raw, scales[axis], now) for axis, raw in answers.items()})
        self.recorded = recorded
        if self.condition.status is not Status.LIVE:
            self.tell(Status.LIVE)
        self._changed.set()

    def tell(self, status: Status, message: str = "", retry_in: float | None = None) -> None:
        """Note the state of the connection."""
        self.condition = Condition(status, printable(message), None if retry_in is None else self.clock() + retry_in)
        self._hear(self.condition)
        self._changed.set()

    async def changed(self, seconds: float) -> None:
        """Wait until something is noted, but no longer than this."""
        try:
            async with asyncio.timeout(seconds):
                await self._changed.wait()
        except TimeoutError:
            pass
        self._changed.clear()
