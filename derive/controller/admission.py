"""Only the page that this server has served may connect, with the token of this run. Any web page can open a WebSocket
to this computer, but it cannot name another origin than its own, and does not know the token.
"""

from __future__ import annotations

import hmac
import ipaddress
import secrets
import socket
from urllib.parse import urlsplit

SUBPROTOCOL = "softkin.live.1"
"""The protocol that the page asks for, and is answered."""
_TOKEN = "token."
"""What precedes the token, the second protocol that the page names: a page can set no header of a WebSocket but this,
and an address with a token in it would stand in histories and records.
"""


def new_token() -> str:
    """A token of 256 bits."""
    return secrets.token_urlsafe(32)


def refusal_of_host(host: str | None, local: str) -> str | None:
    """The reason why a request is refused because of the host that it names; None if it is accepted.

    local: the address of this computer at which the request came in. A name that an attacker may point to this address
    (DNS rebinding) is refused: only the address itself, `localhost`, and the name of this computer are accepted.
    """
    name = _name(f"//{host}") if host else None
    address = _address(local)
    if name is not None and (name in own_names() or (address is not None and _address(name) == address)):
        return None
    return "this server is asked for by its own address alone"


def refusal(host: str | None, origin: str | None, protocols: str | None, local: str, token: str) -> str | None:
    """The reason why a WebSocket is refused, from three headers of its handshake; None if it is accepted."""
    wrong_host = refusal_of_host(host, local)
    if wrong_host:
        return wrong_host
    if origin is None or host is None or origin.lower() != f"http://{host}".lower():
        return "this server answers its own page alone"
    named = [part.strip() for part in (protocols or "").split(",")]
    shown = [part.removeprefix(_TOKEN).encode() for part in named if part.startswith(_TOKEN)]
    if SUBPROTOCOL not in named or not any(hmac.compare_digest(part, token.encode()) for part in shown):
        return "the token is not that of this run: open the address that `softkin live` has printed"
    return None


def own_names() -> frozenset[str]:
    """The names of this computer, in small letters, with and without the name of the network."""
    name = socket.gethostname().lower()
    return frozenset({"localhost", name, name.partition(".")[0]})


def _name(text: str) -> str | None:
    """The host of an address, in small letters."""
    try:
        return urlsplit(text).hostname
    except ValueError:
        return None


def _address(text: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address | None:
    """The address in a text; IPv4 mapped into IPv6 gives the IPv4 address. None for a name."""
    try:
        found = ipaddress.ip_address(text.partition("%")[0])
    except ValueError:
        return None
    return getattr(found, "ipv4_mapped", None) or found
