"""Encryption of OPC UA: this client's own certificate, and the trust in that of the server.

A server is trusted if its certificate is in the file of `--ca`, or names the host of the address and is issued by a
certificate in that file. The authorities that the system trusts do not count. The check comes before a session is
opened, in which the server proves that it holds the key of that certificate.
"""

from __future__ import annotations

import datetime
import ipaddress
import socket
from collections.abc import Sequence
from pathlib import Path

from asyncua import Client, ua
from asyncua.crypto import security_policies
from asyncua.crypto.uacrypto import x509_from_der
from cryptography import x509
from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.asymmetric.rsa import RSAPublicKey
from cryptography.hazmat.primitives.hashes import SHA256
from cryptography.hazmat.primitives.serialization import Encoding

from derive.controller.refusal import Refused
from derive.controller.settings import Security

APPLICATION = "urn:softkin:live"
CERTIFICATE, _KEY = "opcua_certificate.der", "opcua_key.pem"
_POLICIES = (
    security_policies.SecurityPolicyBasic256Sha256,
    security_policies.SecurityPolicyAes256Sha256RsaPss,
    security_policies.SecurityPolicyAes128Sha256RsaOaep,
)
_ENCRYPTED = ua.MessageSecurityMode.SignAndEncrypt


async def encrypt(client: Client, security: Security) -> None:
    """Let the client sign and encrypt with the server that it shall trust. Raises `Refused` if it cannot."""
    anchors = () if security.is_unchecked else _anchors(security.ca)
    endpoints = await client.connect_and_get_server_endpoints()
    host = str(client.server_url.hostname)
    for policy in _POLICIES:
        shown = [e for e in endpoints if e.SecurityMode == _ENCRYPTED and e.SecurityPolicyUri == policy.URI]
        if shown:
            server = x509_from_der(shown[0].ServerCertificate)
            why = None if security.is_unchecked else distrust(server, anchors, host)
            if why:
                print_ = server.fingerprint(SHA256()).hex(":")
                message = f"the certificate of {host} is not trusted: {why} (SHA-256 {print_})"
                raise Refused(f"{message}; give it, or that of its authority, with --ca")
            if not isinstance(server.public_key(), RSAPublicKey):
                raise Refused(f"the certificate of {host} has no RSA key, which OPC UA wants")
            certificate, key = await _own(client, security.identity.expanduser())
            content = server.public_bytes(Encoding.DER)
            await client.set_security(policy, certificate, key, server_certificate=content, mode=_ENCRYPTED)
            return
    raise Refused(f"{host} offers no encryption that is known: --unencrypted reads it without, and without a password")


def distrust(server: x509.Certificate, anchors: Sequence[x509.Certificate], host: str) -> str | None:
    """The reason why a certificate is not trusted at present; None if it is. anchors: the trusted certificates."""
    now = datetime.datetime.now(datetime.UTC)
    if not server.not_valid_before_utc <= now <= server.not_valid_after_utc:
        return f"it is valid from {server.not_valid_before_utc:%Y-%m-%d} to {server.not_valid_after_utc:%Y-%m-%d}"
    if server in anchors:
        return None
    if not any(_issued(server, anchor, now) for anchor in anchors):
        return "nobody vouches for it"
    return None if _names(server, host) else "it is that of another host"


def _issued(server: x509.Certificate, authority: x509.Certificate, now: datetime.datetime) -> bool:
    """Whether a certificate is signed by an authority that is valid, and is allowed to sign."""
    try:
        if not authority.extensions.get_extension_for_class(x509.BasicConstraints).value.ca:
            return False
        server.verify_directly_issued_by(authority)
    except (x509.ExtensionNotFound, InvalidSignature, ValueError, TypeError):
        return False
    return bool(authority.not_valid_before_utc <= now <= authority.not_valid_after_utc)


def _names(server: x509.Certificate, host: str) -> bool:
    """Whether a certificate is that of a host, by its name or its address."""
    try:
        names = server.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return False
    try:
        return ipaddress.ip_address(host) in tuple(names.get_values_for_type(x509.IPAddress))
    except ValueError:
        return host.lower() in {str(name).lower() for name in names.get_values_for_type(x509.DNSName)}


def _anchors(path: Path | None) -> tuple[x509.Certificate, ...]:
    """The certificates in a file, of PEM or DER."""
    if path is None:
        return ()
    try:
        content = path.read_bytes()
        if b"-----BEGIN" in content:
            return tuple(x509.load_pem_x509_certificates(content))
        return (x509.load_der_x509_certificate(content),)
    except (OSError, ValueError) as problem:
        raise Refused(f"{path}: no certificate can be read: {problem}") from None


async def _own(client: Client, folder: Path) -> tuple[Path, Path]:
    """This client's certificate and key, created if there are none; no other user may read the folder."""
    certificate, key = folder / CERTIFICATE, folder / _KEY
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        folder.chmod(0o700)
        await client.setup_self_signed_certificate(key, certificate, host_name=socket.gethostname())
        key.chmod(0o600)
    except OSError as problem:
        raise Refused(f"{folder}: the certificate of this client cannot be kept there: {problem.strerror}") from None
    return certificate, key
