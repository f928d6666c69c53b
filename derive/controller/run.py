"""A live connection from its settings: the source, the stream of messages, and the server of the page."""

from __future__ import annotations

import asyncio
import contextlib
import ipaddress
import socket
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Protocol

from derive.controller.addresses import Kind
from derive.controller.admission import new_token
from derive.controller.credentials import Credentials, are_given, credentials
from derive.controller.feed import Condition, Feed, Status
from derive.controller.messages import about_the_machine
from derive.controller.refusal import Lost, Refused
from derive.controller.settings import Settings
from derive.controller.stream import Stream

EXTRA = "the packages of the extra `live` are missing: pip install 'softkin-compiler[live]'"
LOOPBACK = "127.0.0.1"


def who(settings: Settings) -> Credentials | None:
    """The credentials for the source: a ctrlX always needs them, OPC UA where they are given or asked for."""
    kind, security = settings.address.kind, settings.security
    wanted = kind is Kind.DATA_LAYER or (kind is Kind.OPC_UA and (security.logs_in or are_given()))
    if wanted and security.is_unencrypted:
        raise Refused("a password is never sent unencrypted: leave out --unencrypted, or the user")
    return credentials(settings.address.text) if wanted else None


def source_of(settings: Settings, user: Credentials | None) -> Source:
    """The source, whose packages are loaded here. Raises `Refused`, also where a package is missing."""
    address, channels = settings.address, settings.channels
    try:
        if address.kind is Kind.OPC_UA:
            from derive.controller.sources.opc_ua import OpcUa

            return OpcUa(address.text, channels, settings.rate, settings.security, user)
        if address.kind is Kind.DATA_LAYER and user is not None:
            from derive.controller.sources.data_layer import DataLayer, context

            return DataLayer(address.text, channels, settings.rate, user, context(settings.security))
    except ImportError as problem:
        raise Refused(f"{address.kind.value}: {EXTRA} ({problem})") from None
    if address.kind is Kind.TABLE:
        from derive.controller.sources.table import Replay, recording_of

        recording = recording_of(Path(address.text), channels, settings.time)
        return Replay(recording, settings.speed, settings.is_loop, settings.rate)
    from derive.controller.sources.lines import Input

    return Input(channels, sys.stdin.fileno())


async def live(
    settings: Settings, source: Source, page: Path, bind: str, port: int, say: Callable[[str], None]
) -> None:
    """Serve until it is cancelled. say: gets the address to open, then each change of the connection.

    Raises `Refused` if the page cannot be served, or the source refuses, after the page has been told.
    """
    try:
        from derive.controller.server import serving
    except ImportError as problem:
        raise Refused(f"{EXTRA} ({problem})") from None
    feed, token = Feed(settings.channels, _teller(say)), new_token()
    stream = Stream(settings, feed)
    async with serving(stream, about_the_machine(settings), page, token, bind, port) as (host, chosen):
        say(f"http://{_named(host)}:{chosen}/#live={token}")
        tasks = [asyncio.create_task(part) for part in (stream.run(), keep(source, feed))]
        try:
            await asyncio.gather(*tasks)
        except Refused:
            await stream.finish()
            raise
        finally:
            for task in tasks:
                task.cancel()
            for task in tasks:
                with contextlib.suppress(asyncio.CancelledError, Refused):
                    await task


def _named(host: str) -> str:
    """The host in the address to open; the name of this computer where the server listens at all addresses."""
    if ipaddress.ip_address(host).is_unspecified:
        return socket.gethostname().lower()
    return f"[{host}]" if ":" in host else host


def _teller(say: Callable[[str], None]) -> Callable[[Condition], None]:
    """A function that reports each new condition once, so that a lasting loss is not reported at every try."""
    printed: list[str] = []

    def hear(condition: Condition) -> None:
        text = condition.status.value + (f": {condition.message}" if condition.message else "")
        is_another_try = condition.status is Status.CONNECTING and bool(condition.message)
        if not is_another_try and printed[-1:] != [text]:
            printed.append(text)
            del printed[:-1]
            say(text)

    return hear


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
