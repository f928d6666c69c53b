"""Controllers on loopback: an OPC UA server, and a small one of the data layer's REST interface, over TLS."""

import asyncio
import contextlib
import socket
import ssl
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import trustme
from aiohttp import web
from asyncua import Server, ua
from asyncua.crypto.permission_rules import User, UserRole
from asyncua.server.user_managers import UserManager

USER, PASSWORD = "viewer", "a p§ssword"
HOST = "127.0.0.1"


def free_port() -> int:
    """A port that the system has chosen, for a server that comes back at the same place."""
    with socket.socket() as found:
        found.bind((HOST, 0))
        return int(found.getsockname()[1])


@cache
def authority() -> trustme.CA:
    """An authority that nobody else knows."""
    return trustme.CA()


@cache
def another_authority() -> trustme.CA:
    return trustme.CA()


@cache
def _certificate() -> trustme.LeafCert:
    return authority().issue_cert(HOST, key_type=trustme.KeyType.RSA)


def trusted(folder: Path, of: trustme.CA | None = None) -> Path:
    """The certificate of an authority as a file."""
    path = folder / f"authority_{of is None}.pem"
    (of or authority()).cert_pem.write_to_path(str(path))
    return path


class OneUser(UserManager):  # type: ignore[misc, unused-ignore]
    """Nobody but one user may look."""

    def get_user(
        self, iserver: Any, username: Any = None, password: Any = None, certificate: Any = None
    ) -> User | None:
        """The user, where user and password are right."""
        return User(role=UserRole.User) if (username, password) == (USER, PASSWORD) else None


VARIABLES = {"GVL.x": 1000.0, "GVL.y": 2.0, "GVL.flag": True, "GVL.text": "7", "GVL.whole": -3}
"""What an OPC UA server has, in the namespace 2, `urn:plc`."""


@dataclass
class Plc:
    """An OPC UA server with variables, which can be stopped and started again."""

    server: Server
    port: int
    nodes: dict[str, Any]

    @property
    def address(self) -> str:
        return f"opc.tcp://{HOST}:{self.port}"

    async def start(self) -> None:
        """Listen."""
        await self.server.start()

    async def stop(self) -> None:
        """Stop, as a controller that is switched off."""
        await self.server.stop()

    async def write(self, name: str, value: Any, status: int = ua.StatusCodes.Good) -> None:
        """Give a variable a value, and a quality."""
        given = ua.DataValue(ua.Variant(value, ua.VariantType.Double), ua.StatusCode(status))
        await self.server.write_attribute_value(self.nodes[name].nodeid, given)


async def plc(folder: Path | None = None, users: UserManager | None = None) -> Plc:
    """A running OPC UA server. folder: for its certificate, where it shall encrypt."""
    server = Server(user_manager=users)
    await server.init()
    server.disable_clock()
    port = free_port()
    server.set_endpoint(f"opc.tcp://{HOST}:{port}")
    encrypted = ua.SecurityPolicyType.Basic256Sha256_SignAndEncrypt
    server.set_security_policy([encrypted if folder else ua.SecurityPolicyType.NoSecurity])
    if users:
        server.set_identity_tokens([ua.UserNameIdentityToken])
    if folder:
        certificate = folder / "plc.pem"
        _certificate().private_key_and_cert_chain_pem.write_to_path(str(certificate))
        await server.load_certificate(certificate)
        await server.load_private_key(certificate)
    space = await server.register_namespace("urn:plc")
    add = server.nodes.objects.add_variable
    nodes = {name: await add(ua.NodeId(name, space), name, value) for name, value in VARIABLES.items()}
    found = Plc(server, port, nodes)
    await found.start()
    return found


@dataclass
class Ctrlx:
    """The part of a ctrlX's REST interface that is read here, as the OpenAPI files have it; and what it was asked."""

    port: int
    nodes: dict[str, Any]
    """The answers by path: a number, or an object of JSON as it is, or the number of an error."""
    raw: dict[str, tuple[int, bytes]] = field(default_factory=dict)
    """Answers as they are, of the "log-in" and of every "node"."""
    tokens: set[str] = field(default_factory=set)
    asked: list[str] = field(default_factory=list)
    log_ins: int = 0
    runner: web.AppRunner | None = None

    @property
    def address(self) -> str:
        return f"https://{HOST}:{self.port}"

    async def start(self) -> None:
        """Start, with a certificate of the authority."""
        application = web.Application()
        application.router.add_post("/identity-manager/api/v2/auth/token", self._log_in)
        application.router.add_delete("/identity-manager/api/v2/auth/token", self._log_out)
        application.router.add_get("/automation/api/v2/nodes/{path:.*}", self._read)
        self.runner = web.AppRunner(application, shutdown_timeout=0.1)
        await self.runner.setup()
        context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
        _certificate().configure_cert(context)
        await web.TCPSite(self.runner, HOST, self.port, ssl_context=context).start()

    async def stop(self) -> None:
        """Stop; all tokens are forgotten."""
        self.tokens.clear()
        if self.runner is not None:
            runner, self.runner = self.runner, None
            await runner.cleanup()

    async def _log_in(self, request: web.Request) -> web.Response:
        self.asked.append(str(request.rel_url))
        if "log-in" in self.raw:
            return self._as_it_is("log-in")
        if await request.json() != {"name": USER, "password": PASSWORD}:
            return web.json_response({"type": "about:blank", "title": "Not authorized"}, status=401)
        self.log_ins += 1
        self.tokens.add(f"token{self.log_ins}")
        return web.json_response({"access_token": f"token{self.log_ins}", "token_type": "Bearer"}, status=201)

    async def _log_out(self, request: web.Request) -> web.Response:
        self.tokens.discard(self._token(request))
        return web.Response(status=204)

    async def _read(self, request: web.Request) -> web.Response:
        if self._token(request) not in self.tokens:
            return web.json_response({"title": "Not authorized"}, status=401)
        if "node" in self.raw:
            return self._as_it_is("node")
        found = self.nodes.get(request.match_info["path"], 404)
        if isinstance(found, int):
            return web.json_response({"title": "a problem", "detail": "of this node"}, status=found)
        return web.json_response(found if isinstance(found, dict) else {"type": "double", "value": found})

    def _as_it_is(self, place: str) -> web.Response:
        code, body = self.raw[place]
        return web.Response(status=code, body=body, content_type="application/json")

    @staticmethod
    def _token(request: web.Request) -> str:
        return request.headers.get("Authorization", "").removeprefix("Bearer ")


@asynccontextmanager
async def ctrlx(nodes: Mapping[str, Any]) -> AsyncIterator[Ctrlx]:
    """A running one."""
    found = Ctrlx(free_port(), dict(nodes))
    await found.start()
    try:
        yield found
    finally:
        await found.stop()
        await asyncio.sleep(0.05)  # for TLS connections to be closed


@dataclass
class Wire:
    """A connection to a controller which holds back what it carries while it is cut, as a pulled cable does."""

    target: int
    port: int = field(default_factory=free_port)
    whole: asyncio.Event = field(default_factory=asyncio.Event)
    tasks: set[asyncio.Task[None]] = field(default_factory=set)

    async def accept(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        """Carry both directions of a connection."""
        there = await asyncio.open_connection(HOST, self.target)
        for source, sink in ((reader, there[1]), (there[0], writer)):
            self.tasks.add(asyncio.create_task(self._carry(source, sink)))

    async def _carry(self, source: asyncio.StreamReader, sink: asyncio.StreamWriter) -> None:
        try:
            with contextlib.suppress(ConnectionError):
                while data := await source.read(65536):
                    await self.whole.wait()
                    sink.write(data)
        finally:
            sink.close()


@asynccontextmanager
async def wire(target: int) -> AsyncIterator[Wire]:
    """A wire to a port of this computer."""
    found = Wire(target)
    found.whole.set()
    async with await asyncio.start_server(found.accept, HOST, found.port):
        yield found
        for task in found.tasks:
            task.cancel()
        await asyncio.gather(*found.tasks, return_exceptions=True)
        await asyncio.sleep(0.05)  # for connections to be closed
