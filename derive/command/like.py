"""`like`: the block for a name under which a vendor sells its kinematics, and the meaning of its parameters."""

from __future__ import annotations

import argparse
import tomllib
from dataclasses import dataclass

from derive.description.mechanism import DescriptionError
from derive.emit.language import TEMPLATES

_FILE = TEMPLATES / "vendors.toml"


@dataclass(frozen=True)
class Known:
    """Kinematics of a vendor: `meaning` and `page` are as far as they are published."""

    vendor: str
    names: list[str]
    block: str
    meaning: str
    page: str


def known() -> list[Known]:
    """All of them, in the order of the file."""
    return [Known(**entry) for entry in tomllib.loads(_FILE.read_text(encoding="utf-8"))["kinematics"]]


def table() -> str:
    """The table of the documentation."""
    lines = ["| vendor | name there | block here | parameters there = here | published in |", "|---|---|---|---|---|"]
    for k in known():
        lines.append(f"| {k.vendor} | {', '.join(k.names)} | {k.block} | {k.meaning or '–'} | {k.page} |")
    return "\n".join(lines)


def arguments(parser: argparse.ArgumentParser) -> None:
    """What `like` takes."""
    parser.add_argument(
        "words", nargs="+", metavar="WORD", help="words of the vendor and of the name, as in: klipper delta"
    )
    parser.set_defaults(run=like)


def like(options: argparse.Namespace) -> int:
    """Print every entry that has all of the words; raises `DescriptionError` if none has."""
    words = " ".join(options.words).lower().split()
    found = [k for k in known() if all(word in " ".join((k.vendor, *k.names)).lower() for word in words)]
    if not found:
        vendors = ", ".join(dict.fromkeys(k.vendor for k in known()))
        raise DescriptionError(f"no kinematics with {' '.join(words)!r} is known: name one of {vendors}, for its list")
    for k in found:
        print(f"{k.vendor} {', '.join(k.names)}: {k.block}")
        print(f"  parameters: {k.meaning or 'not known'}\n  published in: {k.page}")
    return 0
