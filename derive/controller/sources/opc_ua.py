"""OPC UA: all nodes in one Read request, at a constant rate.

They are read, not subscribed to: a subscription sends nothing while nothing changes, and sends each axis by itself. An
answer to Read confirms all axes at one moment, so that its age is known and the picture is of one moment. `asyncua`
(LGPL) is imported here and in `opc_ua_trust` alone: it is part of the extra `live`, and is never bundled.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from dataclasses import dataclass
from urllib.parse import urlsplit

from asyncua import Client, ua

from derive.controller.channels import Channel
from derive.controller.credentials import Credentials
from derive.controller.feed import Feed
from derive.controller.reading import Unusable
from derive.controller.refusal import Lost, Refused
from derive.controller.settings import Security
from derive.controller.sources import opc_ua_trust
from derive.controller.sources.pace import ANSWER, Pace

_PORT = 4840
"""The port of OPC UA where an address names none."""
_PATIENCE = 4.0
"""Seconds for a connection."""
_FAREWELL, _ABANDONED = 2.0, 0.1
"""Seconds for the end of a session: usually, and of a server that does not answer."""
_USER = frozenset({"BadUserAccessDenied", "BadIdentityTokenRejected", "BadIdentityTokenInvalid"})
_CLIENT = frozenset({"BadSecurityChecksFailed"})
"""The answers of a controller to a wrong user, and (these or `BadCertificate…`) to a client that it does not trust."""
_NAMESPACE = "nsu="


@dataclass(frozen=True)
class OpcUa:
    """Nodes of an OPC UA server, read at a constant rate."""

    address: str
    channels: Sequence[Channel]
    rate: float
    security: Security
    credentials: Credentials | None

    async def run(self, feed: Feed) -> None:
        """Connect and read until the connection is lost."""
        for name in ("asyncua", "asyncuagds"):  # their logs would repeat the messages of the feed
            logging.getLogger(name).setLevel(logging.CRITICAL)
        try:
            async with self._connected() as client:
                nodes = [await _node(client, channel) for channel in self.channels]
                pace = Pace(self.rate)
                while True:
                    async with asyncio.timeout(ANSWER):
                        values = await client.uaclient.read_attributes(nodes, ua.AttributeIds.Value)
                    feed.take(dict(zip((c.axis for c in self.channels), map(answer, values), strict=True)))
                    await pace.next()
        except Refused:
            raise
        except ua.UaStatusCodeError as problem:
            raise self._lost_or_refused(problem) from None
        except asyncio.CancelledError:
            task = asyncio.current_task()
            if task is None or task.cancelling():
                raise
            raise Lost(f"{self.address} does not answer: the request was given up") from None
        except Exception as problem:  # whatever the server answered, the connection is lost
            words = str(problem) or type(problem).__name__
            raise Lost(f"{self.address} does not answer: {words}") from None

    @asynccontextmanager
    async def _connected(self) -> AsyncIterator[Client]:
        """A session, which is ended on every exit."""
        client = Client(_with_port(self.address), timeout=_PATIENCE)
        client.name = client.description = "softkin live"
        client.application_uri = opc_ua_trust.APPLICATION
        if not self.security.is_unencrypted:
            await opc_ua_trust.encrypt(client, self.security)
        if self.credentials is not None:
            client.set_user(self.credentials.user)
            client.set_password(self.credentials.password)
        async with asyncio.timeout(_PATIENCE):
            await client.connect()
        farewell = _ABANDONED
        try:
            yield client
        except (Refused, asyncio.CancelledError, ua.UaStatusCodeError):
            farewell = _FAREWELL
            raise
        finally:
            try:
                async with asyncio.timeout(farewell):
                    await client.disconnect()
            except TimeoutError:  # the server does not answer any more
                client.disconnect_socket()

    def _lost_or_refused(self, problem: ua.UaStatusCodeError) -> Lost | Refused:
        name = ua.StatusCode(problem.code).name
        if name in _USER:
            who = "this user and password" if self.credentials else "a client without a user: log in with --login"
            return Refused(f"{self.address} does not take {who} ({name})")
        if name in _CLIENT or name.startswith("BadCertificate"):
            own = self.security.identity.expanduser() / opc_ua_trust.CERTIFICATE
            return Refused(f"{self.address} does not trust this client ({name}): let it trust {own}")
        return Lost(f"{self.address}: {name}")


def _with_port(address: str) -> str:
    """The address with a port, which asyncua requires."""
    url = urlsplit(address)
    return address if url.port else url._replace(netloc=f"{url.netloc.rstrip(':')}:{_PORT}").geturl()


async def _node(client: Client, channel: Channel) -> ua.NodeId:
    """The node of a channel; its namespace is given by a number (`ns=`), or by its name (`nsu=`)."""
    text = channel.node
    try:
        if text.startswith(_NAMESPACE):
            name, _, rest = text.removeprefix(_NAMESPACE).partition(";")
            text = f"ns={await client.get_namespace_index(name)};{rest}"
        return ua.NodeId.from_string(text)
    except (ua.UaError, ValueError):
        if channel.node.startswith(_NAMESPACE):
            raise Refused(f"axis {channel.axis}: the server has no node {channel.node!r}") from None
        message = f"axis {channel.axis}: {channel.node!r} is no node of OPC UA, such as ns=4;s=name, or nsu=uri;s=name"
        raise Refused(message) from None


def answer(value: ua.DataValue) -> object:
    """The number in an answer, or the reason why there is none; only a value that the server marks good is a number."""
    status = value.StatusCode
    if status is not None and not status.is_good():
        return Unusable(status.name)
    return value.Value.Value if value.Value is not None else Unusable("no value")
