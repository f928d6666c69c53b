"""The address of a source of axis values: its kind, and the refusal of credentials in it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from urllib.parse import SplitResult, urlsplit

from derive.controller.refusal import Refused

USER, PASSWORD = "SOFTKIN_USER", "SOFTKIN_PASSWORD"
"""The variables of the environment that hold the credentials."""
_REMEDY = f"set {USER} and {PASSWORD}, or leave them out and be asked"
_SECRETS = frozenset(
    "apikey auth credential credentials login pass passphrase passwd password pwd secret token user username".split()
)
"""The names of entries with credentials, in small letters and without `_` and `-`."""


class Kind(Enum):
    """The kinds of sources."""

    OPC_UA = "OPC UA"
    DATA_LAYER = "ctrlX data layer"
    TABLE = "CSV file"
    LINES = "standard input"


@dataclass(frozen=True)
class Address:
    """A source."""

    kind: Kind
    text: str
    """A URL without credentials, the path of a file, or `-`."""

    @property
    def is_named(self) -> bool:
        """Whether nodes are columns, which have the names of their axes unless other names are given."""
        return self.kind in (Kind.TABLE, Kind.LINES)


def address_of(text: str, folder: Path) -> Address:
    """The source that a text names: `opc.tcp://…`, `https://…`, a CSV file, or `-`.

    folder: where a relative path starts. Raises `Refused`; the message does not repeat a wrong URL, because a password
    may stand in it.
    """
    if text == "-":
        return Address(Kind.LINES, text)
    if "://" not in text:
        if ("@" in text or re.match(r"\w[\w.+-]+:", text)) and not (folder / text).exists():
            raise Refused("the source is neither a file nor a URL, such as opc.tcp://host:4840 or https://host")
        return Address(Kind.TABLE, str(folder / text))
    try:
        url = urlsplit(text)
        _ = url.port
    except ValueError:
        raise Refused("the address of the source is no URL: write it as opc.tcp://host:4840 or https://host") from None
    _refuse_more_than_a_place(url)
    if url.scheme == "opc.tcp":
        return Address(Kind.OPC_UA, text)
    if url.scheme == "http":
        raise Refused(f"http://{url.hostname} is not encrypted: a ctrlX answers at https://{url.hostname}")
    if url.scheme != "https":
        raise Refused(f"{url.scheme}:// is no source: it is opc.tcp://, https:// (ctrlX), a CSV file, or - for input")
    if url.path not in ("", "/"):
        raise Refused(f"the address of a ctrlX is https://{url.hostname}: what follows belongs into the nodes")
    return Address(Kind.DATA_LAYER, text.rstrip("/"))


def _refuse_more_than_a_place(url: SplitResult) -> None:
    if "@" in url.netloc:
        raise Refused(f"the address has a user or a password in it: they do not belong there; {_REMEDY}")
    if url.query or url.fragment:
        raise Refused(f"the address has more than a place in it (? or #), such as credentials: leave it out; {_REMEDY}")
    if not url.hostname:
        raise Refused("the address names no host: write it as opc.tcp://host:4840 or https://host")


def refuse_secrets(given: object, where: str) -> None:
    """Refuse credentials anywhere in data of JSON, by the names of their entries. Raises `Refused`."""
    parts: Iterable[object] = ()
    if isinstance(given, Mapping):
        for name in given:
            if str(name).lower().replace("_", "").replace("-", "") in _SECRETS:
                raise Refused(f"{where}: credentials do not belong into a file (entry {str(name)!r}); {_REMEDY}")
        parts = given.values()
    elif isinstance(given, list):
        parts = given
    for part in parts:
        refuse_secrets(part, where)
