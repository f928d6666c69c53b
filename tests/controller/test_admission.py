"""Who may connect, by the headers of a handshake: at loopback, in a network, by names and addresses of both kinds."""

import socket

import pytest

from derive.controller.admission import refusal, refusal_of_host

TOKEN = "0123456789abcdef"
SHOWN = f"softkin.live.1, token.{TOKEN}"


@pytest.mark.parametrize(
    ("host", "local"),
    [
        ("127.0.0.1:8000", "127.0.0.1"),
        ("localhost:8000", "127.0.0.1"),
        ("LOCALHOST", "127.0.0.1"),
        ("[::1]:8000", "::1"),
        ("192.168.1.7:8000", "192.168.1.7"),
        ("192.168.1.7:8000", "::ffff:192.168.1.7"),
        ("[fe80::1]:8000", "fe80::1%eth0"),
        ("[FE80:0::1]", "fe80::1"),
        (f"{socket.gethostname()}:8000", "192.168.1.7"),
        (f"{socket.gethostname()}:8000", "127.0.1.1"),
        ("localhost:9000", "127.0.0.1"),  # carried by SSH
    ],
)
def test_its_own_addresses(host: str, local: str) -> None:
    """The page that is served there may connect."""
    assert refusal_of_host(host, local) is None
    assert refusal(host, f"http://{host}", SHOWN, local, TOKEN) is None


@pytest.mark.parametrize(
    ("host", "local"),
    [
        (None, "127.0.0.1"), ("", "127.0.0.1"), ("evil.example:8000", "127.0.0.1"),
        ("127.0.0.1.evil.example", "127.0.0.1"), ("localhost.evil.example", "127.0.0.1"),
        ("evil.example@127.0.0.1.x", "127.0.0.1"), ("127.0.0.2:8000", "127.0.0.1"),
        ("192.168.1.8:8000", "192.168.1.7"), ("0.0.0.0:8000", "127.0.0.1"), ("[::1", "::1"),
        ("2130706433:8000", "127.0.0.1"), ("evil.example", ""), ("", ""),
    ],
)  # fmt: skip
def test_other_hosts(host: str | None, local: str) -> None:
    """Even where the origin is the same: a name may have been bent to this address."""
    assert refusal_of_host(host, local)
    assert refusal(host, f"http://{host}", SHOWN, local, TOKEN)


@pytest.mark.parametrize(
    "origin", [None, "", "null", "http://", "http://localhost:8000", "file://", "http://127.0.0.1"]
)
def test_other_origins(origin: str | None) -> None:
    """The origin is that of the page that this server serves, to the letter."""
    assert refusal("127.0.0.1:8000", origin, SHOWN, "127.0.0.1", TOKEN)


@pytest.mark.parametrize("shown", [None, "", "softkin.live.1", f"token.{TOKEN}", "softkin.live.1,token.", SHOWN + "0"])
def test_other_tokens(shown: str | None) -> None:
    """Without the token of this run there is nothing; what is refused does not tell it."""
    said = refusal("127.0.0.1:8000", "http://127.0.0.1:8000", shown, "127.0.0.1", TOKEN)
    assert said and TOKEN not in said
