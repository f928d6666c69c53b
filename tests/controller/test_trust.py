"""Who may connect, by the headers of a handshake, and whom OPC UA trusts: for this host, and nobody else."""

import datetime
import socket

import pytest
import trustme
from cryptography import x509

from derive.controller.admission import refusal, refusal_of_host
from derive.controller.sources.opc_ua_trust import distrust
from tests.controller.controllers import HOST, another_authority, authority

DAY = datetime.timedelta(days=1)


def parsed(certificate: trustme.LeafCert | trustme.CA) -> x509.Certificate:
    """The first certificate of a chain, or that of an authority."""
    pem = certificate.cert_pem if isinstance(certificate, trustme.CA) else certificate.cert_chain_pems[0]
    return x509.load_pem_x509_certificate(pem.bytes())


def test_whom_it_trusts() -> None:
    """An authority for the hosts that it has named, in their time; a certificate for whatever host it is at."""
    now = datetime.datetime.now(datetime.UTC)
    server, named = parsed(authority().issue_cert(HOST)), parsed(authority().issue_cert("plc.example"))
    ca, other = parsed(authority()), parsed(another_authority())
    late = parsed(authority().issue_cert(HOST, not_before=now - 2 * DAY, not_after=now - DAY))
    early = parsed(authority().issue_cert(HOST, not_before=now + DAY, not_after=now + 2 * DAY))
    assert distrust(server, (ca,), HOST) is None and distrust(server, (other, ca), HOST) is None
    assert distrust(named, (ca,), "PLC.example") is None
    assert distrust(server, (server,), "10.0.0.7") is None, "the certificate itself is that of the controller"
    assert distrust(server, (), HOST) == distrust(server, (other,), HOST) == "nobody vouches for it"
    assert distrust(server, (named,), HOST) == "nobody vouches for it", "what is no authority vouches for nobody"
    for certificate, host in ((server, "10.0.0.7"), (server, "localhost"), (named, HOST), (named, "example")):
        assert distrust(certificate, (ca,), host) == "it is that of another host"
    for certificate in (late, early):
        assert "it is valid from" in str(distrust(certificate, (ca, certificate), HOST))


def test_an_authority_of_the_same_name_is_another() -> None:
    """Names are not what is compared: the signature is."""
    same = trustme.CA(organization_name="Mine", organization_unit_name="Mine")
    fake = trustme.CA(organization_name="Mine", organization_unit_name="Mine")
    assert parsed(same).subject == parsed(fake).subject
    assert distrust(parsed(fake.issue_cert(HOST)), (parsed(same),), HOST) == "nobody vouches for it"


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
    "origin", [None, "", "null", "http://", "http://localhost:8000", "file://", "http://127.0.0.1",
               "https://127.0.0.1:8000", "http://127.0.0.1.evil.example:8000", "http://127.0.0.1:7999"]
)  # fmt: skip
def test_other_origins(origin: str | None) -> None:
    """The origin is that of the page that this server serves, to the letter."""
    assert refusal("127.0.0.1:8000", origin, SHOWN, "127.0.0.1", TOKEN)


@pytest.mark.parametrize(
    "shown", [None, "", "softkin.live.1", f"token.{TOKEN}", "softkin.live.1,token.", SHOWN + "0", SHOWN[:-1],
              f"softkin.live.1, {TOKEN}", f"softkin.live.2, token.{TOKEN}"]
)  # fmt: skip
def test_other_tokens(shown: str | None) -> None:
    """Without the token of this run there is nothing; what is refused does not tell it."""
    said = refusal("127.0.0.1:8000", "http://127.0.0.1:8000", shown, "127.0.0.1", TOKEN)
    assert said and TOKEN not in said
