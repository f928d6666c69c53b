"""`live`: serve the page that draws a machine, and move it with the axis values of a controller."""

from __future__ import annotations

import argparse
import asyncio
import gc
import ipaddress
import sys
from pathlib import Path

from derive.command.own import complain, package_of
from derive.controller.machine import Machine
from derive.controller.refusal import Refused
from derive.controller.run import LOOPBACK, live, source_of, who
from derive.controller.settings import Security, settings_of

BUILT = Path("build")
"""The folder of the viewer's pages, for the catalogue and for machines of a user's own."""
_WRONG = 2


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The options of `live`."""
    parser.add_argument(
        "--machine", type=Path, required=True, metavar="FILE", help="the machine, as JSON: docs/LIVE.md"
    )
    parser.add_argument(
        "--source", metavar="ADDRESS", help="opc.tcp://…, https://… (ctrlX), a CSV file, or - for input"
    )
    text = "which node is which axis, and its scale: A1=node or A1=node*scale; may be repeated"
    parser.add_argument("--axis", action="append", default=[], metavar="A1=NODE", help=text)
    text = f"the page (default: {BUILT}/viewer.html, or for a machine of your own the one of `softkin view` in {BUILT})"
    parser.add_argument("--page", type=Path, metavar="FILE", help=text)
    text = f"the address of this computer to serve at (default: {LOOPBACK}, which no other computer reaches)"
    parser.add_argument("--bind", default=LOOPBACK, metavar="ADDRESS", help=text)
    parser.add_argument("--port", type=int, default=0, help="the port (default: one that is free)")
    parser.add_argument("--rate", type=float, metavar="N", help="updates a second (default: 50)")
    text = "seconds after which a value that nothing confirms is shown as stale (default: 1)"
    parser.add_argument("--stale-after", type=float, metavar="SECONDS", help=text)
    replay = parser.add_argument_group("a CSV file")
    replay.add_argument(
        "--time", metavar="COLUMN", help="the column of the time, as t or t_ms*0.001 (default: time, t)"
    )
    replay.add_argument("--speed", type=float, metavar="N", help="how much faster than recorded (default: 1)")
    replay.add_argument("--loop", action="store_true", default=None, help="start again at the end")
    _trust(parser.add_argument_group("trust, of OPC UA and ctrlX"))
    parser.set_defaults(run=run)


def _trust(parser: argparse._ArgumentGroup) -> None:
    text = "log in to OPC UA: with SOFTKIN_USER and SOFTKIN_PASSWORD of the environment, else they are asked"
    parser.add_argument("--login", action="store_true", help=text)
    text = "the certificate of the controller's authority, or the controller's own"
    parser.add_argument("--ca", type=Path, metavar="FILE", help=text)
    text = "take any certificate: nothing then tells the controller from somebody between"
    parser.add_argument("--insecure-certificate", action="store_true", help=text)
    parser.add_argument("--unencrypted", action="store_true", help="read OPC UA without encryption and without a user")
    text = "the folder of this client's own OPC UA certificate, made where there is none (default: ~/.softkin)"
    parser.add_argument("--identity", type=Path, default=Security.identity, metavar="FOLDER", help=text)


def run(options: argparse.Namespace) -> int:
    """Serve until interrupted; returns 2, after a message of one sentence, where that is impossible."""
    gc.enable()  # this serves for days
    try:
        asyncio.run(_live(options))
    except Refused as problem:
        complain(str(problem))
        return _WRONG
    return 0


async def _live(options: argparse.Namespace) -> None:
    security = Security(options.ca, options.insecure_certificate, options.unencrypted, options.login, options.identity)
    source = {
        "address": options.source,
        **{name: getattr(options, name) for name in ("rate", "stale_after", "speed", "loop", "time")},
    }
    settings = settings_of(options.machine, options.axis, source, security)
    page = options.page or _page_of(settings.machine)
    if not page.is_file():
        command = f"softkin view {settings.machine.own}" if settings.machine.own else "make view"
        raise Refused(f"{page}: there is no page; `{command}` builds it, or name another one with --page")
    if not _is_loopback(options.bind):
        _say(f"warning: {options.bind} can be reached by other computers, and what is sent to them is not encrypted")
    if security.is_unchecked:
        _say("warning: the certificate of the controller is not checked")
    await live(settings, source_of(settings, who(settings)), page, options.bind, options.port, _say)


def _page_of(machine: Machine) -> Path:
    """The page that `view` writes of a machine into the folder where it writes by default."""
    name = "viewer" if machine.own is None else package_of(machine.own, None)
    return BUILT / f"{name}.html"


def _is_loopback(address: str) -> bool:
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return address == "localhost"


def _say(text: str) -> None:
    """Print at once, because another program may wait for the address."""
    print(text, file=sys.stdout, flush=True)
