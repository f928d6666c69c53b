"""The server of the page and its WebSocket: it only sends, and does not read messages of a page.

`aiohttp` (Apache-2.0) serves both, and asks the ctrlX data layer; it is part of the extra `live`.
"""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from pathlib import Path

from aiohttp import WSCloseCode, web

from derive.controller.admission import SUBPROTOCOL, refusal, refusal_of_host
from derive.controller.refusal import Refused
from derive.controller.stream import Stream

SOCKET = "/live"
MOST_PAGES = 16
"""The largest number of pages that may be open at the same time."""
_HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; object-src 'none'",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
_ALIVE = 10.0
"""Seconds between checks whether a page is still there."""
_LONGEST_MESSAGE = 1024


@asynccontextmanager
async def serving(
    stream: Stream, greeting: str, page: Path, token: str, bind: str, port: int
) -> AsyncIterator[tuple[str, int]]:
    """Serve the page and the messages of a stream; gives the address and the port, chosen by the system where it is 0.

    Raises `Refused` if there is no such address, or the port is taken.
    """
    application = web.Application()
    pages: set[web.WebSocketResponse] = set()

    async def close(_: web.Application) -> None:
        for opened in tuple(pages):
            await opened.close(code=WSCloseCode.GOING_AWAY)

    application.on_shutdown.append(close)
    application.router.add_get("/", _page(page))
    application.router.add_get(SOCKET, _socket(stream, greeting, token, pages))
    runner = web.AppRunner(application, access_log=None, shutdown_timeout=2.0)
    await runner.setup()
    try:
        try:
            await web.TCPSite(runner, bind, port).start()
        except OSError as problem:
            raise Refused(f"cannot serve at {bind}, port {port}: {problem.strerror or problem}") from None
        yield runner.addresses[0][0], runner.addresses[0][1]
    finally:
        await runner.cleanup()


Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


def _page(path: Path) -> Handler:
    """The handler of the page, which reads the file at every request."""

    async def answer(request: web.Request) -> web.StreamResponse:
        wrong = refusal_of_host(request.headers.get("Host"), _local(request))
        if wrong:
            raise web.HTTPForbidden(text=wrong)
        try:
            body = path.read_bytes()
        except OSError as problem:
            raise web.HTTPNotFound(text=f"{path}: {problem.strerror}") from None
        return web.Response(body=body, content_type="text/html", charset="utf-8", headers=_HEADERS)

    return answer


def _socket(stream: Stream, greeting: str, token: str, pages: set[web.WebSocketResponse]) -> Handler:
    """The handler of the WebSocket: it sends a greeting, then every newest message. pages: the open ones."""

    async def answer(request: web.Request) -> web.StreamResponse:
        headers = request.headers
        protocols = ",".join(headers.getall("Sec-WebSocket-Protocol", []))
        wrong = refusal(headers.get("Host"), headers.get("Origin"), protocols, _local(request), token)
        if wrong:
            raise web.HTTPForbidden(text=wrong)
        if len(pages) >= MOST_PAGES:
            raise web.HTTPServiceUnavailable(text=f"{MOST_PAGES} pages are open: close one of them")
        opened = web.WebSocketResponse(
            protocols=(SUBPROTOCOL,), heartbeat=_ALIVE, timeout=1.0, max_msg_size=_LONGEST_MESSAGE, compress=False
        )
        await opened.prepare(request)
        pages.add(opened)
        sending = asyncio.create_task(_send(opened, stream, greeting))
        try:
            async for _ in opened:
                pass
        finally:
            pages.discard(opened)
            sending.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await sending
        return opened

    return answer


async def _send(opened: web.WebSocketResponse, stream: Stream, greeting: str) -> None:
    """Send until the stream is over, or the page is gone."""
    with contextlib.suppress(ConnectionError):
        await opened.send_str(greeting)
        async for text in stream.newest():
            await opened.send_str(text)
        await opened.close()


def _local(request: web.Request) -> str:
    """The address of this computer at which a request came in."""
    name = request.transport.get_extra_info("sockname") if request.transport else None
    return str(name[0]) if name else ""
