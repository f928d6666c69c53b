"""Whom OPC UA trusts: by the certificate itself or by its authority, now, for this host; nobody else."""

import datetime

import trustme
from cryptography import x509

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
