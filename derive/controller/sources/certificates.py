"""The check of a controller's certificate, for TLS."""

from __future__ import annotations

import ssl

from derive.controller.refusal import Refused
from derive.controller.settings import Security


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
