"""A live connection as a page sees it, by a WebSocket client, in the same process."""

import asyncio
import json
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import aiohttp

from derive.controller.run import Source, live, source_of, who
from derive.controller.settings import Security, Settings, settings_of
from tests.controller.controllers import Wire

PATIENCE = 15.0
"""Seconds after which a test gives up: far more than anything takes on a quiet machine."""
GANTRY = {"machine": {"mechanism": "Kin_Gantry2"}}
Message = dict[str, Any]


@dataclass
class Served:
    task: asyncio.Task[None]
    said: list[str] = field(default_factory=list)

    @property
    def url(self) -> str:
        """The address without the token."""
        return self.said[0].partition("#")[0]

    @property
    def token(self) -> str:
        return self.said[0].partition("#live=")[2]

    @property
    def origin(self) -> str:
        parts = urlsplit(self.url)
        return f"{parts.scheme}://{parts.netloc}"


def settings(folder: Path, given: Mapping[str, Any], security: Security | None = None, *nodes: str) -> Settings:
    path = folder / "machine.json"
    path.write_text(json.dumps(given), encoding="utf-8")
    return settings_of(path, nodes, None, security)


@asynccontextmanager
async def served(told: Settings, page: Path | None = None, source: Source | None = None) -> AsyncIterator[Served]:
    """The server at loopback, with the source of the settings unless another one is given."""
    said: list[str] = []
    found = source or source_of(told, who(told))
    running = Served(asyncio.create_task(live(told, found, page or Path(__file__), "127.0.0.1", 0, said.append)), said)
    try:
        await until(lambda: bool(said) or running.task.done())
        if not said:
            await running.task
        yield running
    finally:
        running.task.cancel()
        await asyncio.gather(running.task, return_exceptions=True)


@asynccontextmanager
async def page_of(running: Served, **headers: str | None) -> AsyncIterator[aiohttp.ClientWebSocketResponse]:
    """The WebSocket of its page. headers: others than those of the page; None for none."""
    told = {
        "Origin": running.origin,
        "Sec-WebSocket-Protocol": f"softkin.live.1, token.{running.token}",
        **{name.replace("_", "-"): value for name, value in headers.items()},
    }
    shown = {name: value for name, value in told.items() if value is not None}
    async with aiohttp.ClientSession() as session, session.ws_connect(f"{running.url}live", headers=shown) as opened:
        yield opened


async def refused(running: Served, **headers: str | None) -> int:
    """The number with which the server answers a handshake that it refuses; 101 where it does not."""
    try:
        async with page_of(running, **headers):
            return 101
    except aiohttp.WSServerHandshakeError as problem:
        return problem.status


async def message(opened: aiohttp.ClientWebSocketResponse) -> Message:
    """The next message."""
    found: Message = json.loads(await opened.receive_str(timeout=PATIENCE))
    return found


async def message_where(opened: aiohttp.ClientWebSocketResponse, holds: Callable[[Message], bool]) -> Message:
    """The first message about the axes of which this holds."""
    async with asyncio.timeout(PATIENCE):
        while True:
            found = await message(opened)
            if found["type"] == "axes" and holds(found):
                return found


async def until(holds: Callable[[], bool]) -> None:
    """Wait until this holds."""
    async with asyncio.timeout(PATIENCE):
        while not holds():
            await asyncio.sleep(0.01)


async def found_again(told: Settings, wire: Wire) -> list[float]:
    """The axes after a loss: a cut wire is noticed within a second, and the source is live within three of its return.

    The page counts down to the next try. A busy machine has as much time again.
    """
    async with served(told) as running, page_of(running) as page:
        await message_where(page, lambda m: m["complete"])
        wire.whole.clear()
        async with asyncio.timeout(2.0):
            waits = [(await message_where(page, lambda m: m["status"] == "lost"))["retry_in"]]
        while (seen := await message_where(page, lambda _: True))["status"] == "lost":
            waits.append(seen["retry_in"])
        assert len(waits) > 2 and waits == sorted(waits, reverse=True) and 0.8 <= waits[0] <= 1.0
        await message_where(page, lambda m: m["status"] == "lost")  # tried once more, and not answered
        wire.whole.set()
        async with asyncio.timeout(6.0):
            found: list[float] = (await message_where(page, lambda m: m["status"] == "live"))["axes"]
            return found
