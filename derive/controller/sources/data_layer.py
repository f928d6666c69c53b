"""The data layer of a ctrlX, by its REST interface.

From Rexroth's public OpenAPI files (repository boschrexroth/rest-api-description on GitHub, folder
ctrlx-automation/ctrlx-core, release 4.6):

* identitymanager.v2.10.0, POST /identity-manager/api/v2/auth/token with {"name", "password"}: 201 and {"access_token",
  "token_type": "Bearer"}; 401 for wrong credentials, 400 and 500 with a `Problem`. DELETE there ends the session: 204.
* datalayer.v2.1.5, GET /automation/api/v2/nodes/{Path} with the token: 200 and {"type", "value"}; 400, 401, 403, 404
  and 500 with a `Problem` of `title` and `detail`. The types of numbers are those of `_NUMBERS`.

These files leave some points open, which are decided here: a number that is not finite has no form in JSON, so that
any value but a number is bad; an expired token is answered by 401, after which a new one is requested; the separators
of a path are sent unchanged, everything else is escaped; a refused log-in other than 401 or 403 is tried again, because
a controller that is starting, or has too many sessions, gives other answers.
"""

from __future__ import annotations

import asyncio
import contextlib
import ssl
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

import aiohttp
from yarl import URL

from derive.controller.channels import Channel
from derive.controller.credentials import Credentials
from derive.controller.feed import Feed
from derive.controller.reading import Unusable, read_json, shown
from derive.controller.refusal import Lost, Refused
from derive.controller.settings import Security
from derive.controller.sources.pace import ANSWER, Pace

TOKEN_PATH = "/identity-manager/api/v2/auth/token"
NODES_PATH = "/automation/api/v2/nodes/"
_INTEGERS = tuple(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64))
_NUMBERS = frozenset({"float", "double", "float32", "float64", *_INTEGERS})
_CREATED, _OK, _UNAUTHORIZED, _FORBIDDEN = 201, 200, 401, 403
_PATIENCE, _ANSWER = aiohttp.ClientTimeout(total=4.0), aiohttp.ClientTimeout(total=ANSWER)
"""Seconds for a log-in, and for the answer about a node."""
_MOST = 65536
"""The largest number of bytes of an answer about one node."""


class _Expired(Exception):
    """The token is no longer accepted."""


@dataclass(frozen=True)
class DataLayer:
    """Nodes of a ctrlX, read at a constant rate."""

    address: str
    channels: Sequence[Channel]
    rate: float
    credentials: Credentials
    trust: ssl.SSLContext

    async def run(self, feed: Feed) -> None:
        """Log in and read until the connection is lost."""
        connector = aiohttp.TCPConnector(ssl=self.trust, limit=len(self.channels))
        jar = aiohttp.DummyCookieJar()
        try:
            async with aiohttp.ClientSession(connector=connector, timeout=_PATIENCE, cookie_jar=jar) as session:
                while True:
                    await self._read(session, await self._token(session), feed)
        except aiohttp.ClientConnectorCertificateError as problem:
            message = f"the certificate of {self.address} is not trusted: {problem.certificate_error}"
            raise Refused(f"{message}; name its authority with --ca, or look at the address") from None
        except (aiohttp.ClientError, TimeoutError, OSError) as problem:
            raise Lost(f"{self.address} does not answer: {problem or type(problem).__name__}") from None

    async def _token(self, session: aiohttp.ClientSession) -> str:
        """A bearer token for the credentials."""
        body = {"name": self.credentials.user, "password": self.credentials.password}
        async with session.post(f"{self.address}{TOKEN_PATH}", json=body, allow_redirects=False) as answer:
            given = await _object(answer)
            if answer.status in (_UNAUTHORIZED, _FORBIDDEN):
                raise Refused(f"{self.address} does not know this user and password: {_problem(answer, given)}")
            token = given.get("access_token")
            is_token = isinstance(token, str) and token.isascii() and token.isprintable()
            if answer.status != _CREATED or not is_token:
                raise Lost(f"{self.address} gives no token: {_problem(answer, given)}")
            return str(token)

    async def _read(self, session: aiohttp.ClientSession, token: str, feed: Feed) -> None:
        """Read with one token for as long as it is accepted; on every other exit end its session."""
        headers = {"Authorization": f"Bearer {token}", "Accept": "application/json"}
        pace = Pace(self.rate)
        is_taken = False
        try:
            while True:
                feed.take(await self._all(session, headers))
                is_taken = True
                await pace.next()
        except _Expired:
            if not is_taken:
                raise Refused(f"{self.address} has given a token, and does not take it") from None
        except TimeoutError:  # whoever does not answer is not asked for the end of a session
            raise
        except BaseException:
            with contextlib.suppress(aiohttp.ClientError, TimeoutError, OSError):
                async with session.delete(f"{self.address}{TOKEN_PATH}", headers=headers, timeout=_END):
                    pass
            raise

    async def _all(self, session: aiohttp.ClientSession, headers: Mapping[str, str]) -> dict[str, object]:
        """The values of the nodes, all requested at the same time."""
        asked = [asyncio.ensure_future(self._one(session, headers, channel.node)) for channel in self.channels]
        try:
            values = await asyncio.gather(*asked)
        finally:
            for one in asked:
                one.cancel()
            await asyncio.gather(*asked, return_exceptions=True)
        return dict(zip((channel.axis for channel in self.channels), values, strict=True))

    async def _one(self, session: aiohttp.ClientSession, headers: Mapping[str, str], node: str) -> object:
        """The value of a node, or the reason why it is no number."""
        url = URL(f"{self.address}{NODES_PATH}{quote(node.strip('/'), safe='/')}", encoded=True)
        async with session.get(url, headers=headers, allow_redirects=False, timeout=_ANSWER) as answer:
            given = await _object(answer)
            if answer.status == _UNAUTHORIZED:
                raise _Expired
            if answer.status != _OK:
                return Unusable(_problem(answer, given))
            kind = given.get("type")
            is_number = isinstance(kind, str) and kind in _NUMBERS
            return given.get("value") if is_number else Unusable(f"no number, but of the type {shown(kind)}")


_END = aiohttp.ClientTimeout(total=1.0)
"""Seconds for the end of a session."""


async def _object(answer: aiohttp.ClientResponse) -> dict[str, Any]:
    """The object of JSON in an answer; empty if it is none, or is too long."""
    body = b""
    async for part in answer.content.iter_any():
        body += part
        if len(body) > _MOST:
            return {}
    try:
        given = read_json(body)
    except ValueError:
        return {}
    return given if isinstance(given, dict) else {}


def _problem(answer: aiohttp.ClientResponse, given: Mapping[str, Any]) -> str:
    """The error in an answer: its number and the words of its `Problem`."""
    said = [given.get(name) for name in ("title", "detail")]
    words = [word[:120] for word in said if isinstance(word, str) and word]
    return " ".join([str(answer.status), *(words or [answer.reason or ""])]).strip()


def context(security: Security) -> ssl.SSLContext:
    """A context that checks the certificate and the name of the host, unless that is switched off. Raises `Refused`."""
    if security.is_unchecked:
        found = ssl.create_default_context()
        found.check_hostname = False
        found.verify_mode = ssl.CERT_NONE
        return found
    try:
        return ssl.create_default_context(cafile=security.ca)
    except (OSError, ssl.SSLError) as problem:
        raise Refused(f"{security.ca}: no certificate (PEM) can be read: {problem}") from None
