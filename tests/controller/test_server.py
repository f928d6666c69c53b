"""The server: who is let in, what is served, and what pages are told; with a source that the test is."""

import asyncio
import json
import socket
from dataclasses import dataclass, field
from pathlib import Path

import aiohttp
import pytest

from derive.controller.feed import Feed, Status
from derive.controller.reading import Unusable
from derive.controller.refusal import Lost, Refused
from derive.controller.run import WAIT, keep, live
from derive.controller.server import MOST_PAGES
from derive.controller.settings import Settings
from derive.controller.sources.pace import ANSWER
from tests.controller.pages import GANTRY, PATIENCE, message, message_where, page_of, refused, served, settings


@dataclass
class Given:
    """A source that gives what it is given: answers, or an end."""

    queue: asyncio.Queue[dict[str, object] | Exception] = field(default_factory=asyncio.Queue)

    async def run(self, feed: Feed) -> None:
        """Pass on; an exception is raised, and no answers are the end."""
        while True:
            found = await self.queue.get()
            if isinstance(found, Exception):
                raise found
            if not found:
                return
            feed.take(found)


@pytest.fixture
def told(tmp_path: Path) -> Settings:
    """Two axes; the source of the settings is not used."""
    return settings(tmp_path, {**GANTRY, "source": {"address": "-", "stale_after": 0.3}})


async def test_who_is_let_in(told: Settings) -> None:
    """The page of this server with the token of this run; all others are those of `test_trust`."""
    async with served(told, source=Given()) as running:
        port = running.origin.rpartition(":")[2]
        assert await refused(running) == 101
        for origin in (None, "http://evil.example", f"http://127.0.0.1:{int(port) - 1}"):
            assert await refused(running, Origin=origin) == 403, origin
        for protocols in (None, f"softkin.live.1, token.{running.token}x", "softkin.live.1, token.é"):
            assert await refused(running, Sec_WebSocket_Protocol=protocols) == 403, protocols
        host = f"evil.example:{port}"
        assert await refused(running, Host=host, Origin=f"http://{host}") == 403, "a name bent to this address"
        host = f"localhost:{port}"
        assert await refused(running, Host=host, Origin=f"http://{host}") == 101


async def test_the_page_and_its_headers(told: Settings, tmp_path: Path) -> None:
    """The file as it is when it is asked for; nothing else; not by a name bent to this address."""
    page = tmp_path / "page.html"
    page.write_text("<p>ä</p>", encoding="utf-8")
    async with served(told, page, Given()) as running, aiohttp.ClientSession() as session:
        async with session.get(running.url) as answer:
            assert await answer.text() == "<p>ä</p>" and answer.content_type == "text/html"
            assert answer.headers["Cache-Control"] == "no-store" and answer.headers["X-Frame-Options"] == "DENY"
            assert "frame-ancestors 'none'" in answer.headers["Content-Security-Policy"]
        page.write_text("new", encoding="utf-8")
        async with session.get(running.url) as answer:
            assert await answer.text() == "new"
        for path, headers, status in (
            ("page.html", {}, 404),
            ("../page.html", {}, 404),
            ("", {"Host": "evil.example"}, 403),
            ("live", {"Origin": running.origin}, 403),
        ):
            async with session.get(f"{running.url}{path}", headers=headers) as answer:
                assert answer.status == status, path
        async with session.post(running.url) as answer:
            assert answer.status == 405


async def test_it_listens_at_loopback_alone(told: Settings) -> None:
    """The port is closed at the other addresses of this computer; a token is new in every run."""
    async with served(told, source=Given()) as running, served(told, source=Given()) as another:
        port = int(running.origin.rpartition(":")[2])
        assert running.origin.startswith("http://127.0.0.1:") and len(running.token) >= 43
        assert running.token != another.token
        with socket.socket() as other:
            other.bind(("127.0.0.2", port))  # free, where the server does not listen at all addresses
        assert await refused(running, Sec_WebSocket_Protocol=f"softkin.live.1, token.{another.token}") == 403


def test_an_address_that_is_not_ours(told: Settings) -> None:
    """Refused with a sentence, and so is a port that is taken."""

    async def run(bind: str, port: int) -> None:
        await live(told, Given(), Path(__file__), bind, port, lambda _: None)

    with pytest.raises(Refused, match=r"cannot serve at 192\.0\.2\.1, port 0"):
        asyncio.run(run("192.0.2.1", 0))
    with socket.create_server(("127.0.0.1", 0)) as taken, pytest.raises(Refused, match="cannot serve at 127"):
        asyncio.run(run("127.0.0.1", taken.getsockname()[1]))


async def test_messages_of_a_value_through_its_life(told: Settings) -> None:
    """Missing, good, bad, good, stale, over: never a number where there is none. Who comes late sees the same."""
    source = Given()
    async with served(told, source=source) as running, page_of(running) as page:
        seen = await message_where(page, lambda m: m["status"] == "connecting")
        assert (seen["axes"], seen["quality"], seen["complete"]) == ([None, None], ["missing"] * 2, False)
        source.queue.put_nowait({"X": 1.0})
        half = await message_where(page, lambda m: m["status"] == "live")
        assert (half["axes"], half["quality"], half["complete"]) == ([1.0, None], ["good", "missing"], False)
        source.queue.put_nowait({"Y": -2.0})
        assert (await message_where(page, lambda m: m["complete"]))["axes"] == [1.0, -2.0]
        source.queue.put_nowait({"Y": Unusable("the encoder is off")})
        bad = await message_where(page, lambda m: not m["complete"])
        assert (bad["axes"], bad["reasons"]) == ([1.0, None], ["", "the encoder is off"])
        source.queue.put_nowait({"X": 1.0, "Y": 10**400})
        huge = await message_where(page, lambda m: m["reasons"][1] != "the encoder is off")
        assert huge["quality"] == ["good", "bad"]
        source.queue.put_nowait({"X": 3.0, "Y": 4.0})
        stale = await message_where(page, lambda m: m["complete"] and "good" not in m["quality"])
        assert (stale["axes"], stale["quality"]) == ([3.0, 4.0], ["stale", "stale"]) and min(stale["ages"]) > 0.3
        source.queue.put_nowait({})
        over = await message_where(page, lambda m: m["status"] == "ended")
        assert over["axes"] == [3.0, 4.0]
        async with page_of(running) as late:
            assert json.loads(await late.receive_str())["type"] == "machine"
            assert (await message(late))["axes"] == [3.0, 4.0]


async def test_a_refusal_is_told_to_the_page_before_the_server_ends(told: Settings) -> None:
    """The last message says why; then the WebSocket is closed, and the server raises the same."""
    source = Given()
    async with served(told, source=source) as running, page_of(running) as page:
        await message_where(page, lambda m: True)
        source.queue.put_nowait(Refused("the password has been changed"))
        last = await message_where(page, lambda m: m["status"] == "refused")
        assert last["message"] == "the password has been changed"
        assert (await page.receive(PATIENCE)).type in (aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSED)
        with pytest.raises(Refused, match="the password has been changed"):
            await running.task


async def test_a_page_that_does_not_read_delays_nobody(told: Settings) -> None:
    """Another page gets what is new; there are never more pages than allowed, and one that has gone makes room."""
    source = Given()
    async with served(told, source=source) as running, page_of(running), page_of(running) as reading:
        for value in range(20):
            source.queue.put_nowait({"X": float(value), "Y": Unusable("x" * 1_000_000)})  # no buffer holds 20 of them
            await message_where(reading, lambda m, wanted=value: m["axes"][0] == wanted)  # type: ignore[misc]
        source.queue.put_nowait({"X": 0.0, "Y": 0.0})
        opened = [page_of(running) for _ in range(MOST_PAGES - 2)]
        for one in opened:
            await one.__aenter__()
        assert await refused(running) == 503
        for one in opened:
            await one.__aexit__(None, None, None)
        await asyncio.sleep(0.1)
        assert await refused(running) == 101


def test_every_wait_is_as_short_as_the_first(told: Settings) -> None:
    """A source that was lost for long is found again as soon as one that has just been lost."""
    waits: list[float] = []

    async def wait(seconds: float) -> None:
        waits.append(seconds)

    async def run() -> list[Status]:
        heard: list[Status] = []
        source, feed = Given(), Feed(told.channels, lambda condition: heard.append(condition.status))
        for found in (*[Lost("x")] * 7, {"X": 1.0}, Lost("y"), Lost("z"), {}):
            source.queue.put_nowait(found)
        await keep(source, feed, wait)
        return heard

    heard = asyncio.run(run())
    assert waits == [WAIT] * 9 and WAIT + ANSWER < 2.0
    tried = [Status.CONNECTING, Status.LOST]
    assert heard == [*tried * 7, Status.CONNECTING, Status.LIVE, Status.LOST, *tried, Status.CONNECTING, Status.ENDED]


async def test_at_all_addresses_the_name_of_this_computer_is_shown(told: Settings) -> None:
    """`0.0.0.0` is no address to open; the page may be asked for by every address that leads here."""
    said: list[str] = []
    task = asyncio.create_task(live(told, Given(), Path(__file__), "0.0.0.0", 0, said.append))
    while not said:
        await asyncio.sleep(0.01)
    host, _, port = said[0].removeprefix("http://").partition("/")[0].rpartition(":")
    assert host == socket.gethostname().lower()
    async with aiohttp.ClientSession() as session:
        for name, status in (("127.0.0.1", 200), (host, 200), ("0.0.0.0", 403)):
            headers = {"Host": f"{name}:{port}"}
            async with session.get(f"http://127.0.0.1:{port}/", headers=headers) as answer:
                assert answer.status == status
    task.cancel()
    await asyncio.gather(task, return_exceptions=True)
