"""Every emitted object parses with a second, independent grammar."""

from __future__ import annotations

from tests.execution.units import FOLDER
from tests.st.pieces import Piece, split


def pieces() -> dict[tuple[str, str], str]:
    """Kind and text of every object and member, each once, with a name: many units share a method to the letter."""
    found: dict[tuple[str, str], str] = {}
    for path in sorted(FOLDER.glob("*/*.st")):
        for piece in split(path.read_text(encoding="utf-8"), path.name):
            for part in (piece, *piece.members):
                text = "\n".join(line for line in part.text.split("\n") if line.strip())
                found.setdefault((part.kind, text), f"{path.stem}.{name_of(part)}")
    return found


def name_of(piece: Piece) -> str:
    return piece.text.split("\n", 1)[0].removesuffix(" IMPLEMENTS")


PIECES = pieces()
