"""Every emitted object parses with a second, independent grammar.

It is slow. So what is the same to a grammar is parsed once, and all names apart; one unit is parsed as it is written.
"""

from __future__ import annotations

import lark
import pytest

from tests.harness.blark_grammar import parse_text_with_blark, parse_with_blark
from tests.harness.pieces import Piece, split
from tests.text.shapes import abridged, names, shape
from tests.text.units import FOLDER

TEXTS = {path.stem: path.read_text(encoding="utf-8") for path in sorted(FOLDER.glob("*/*.st"))}
WHOLE = "Softkin_Gantry2"


def pieces() -> dict[tuple[str, str], tuple[str, str]]:
    """Name and text of the first object or member of every kind and shape."""
    seen: set[str] = set()
    found: dict[tuple[str, str], tuple[str, str]] = {}
    for unit, text in TEXTS.items():
        for piece in split(text, unit):
            for part in (piece, *piece.members):
                short = abridged(part.text, seen)
                found.setdefault((part.kind, shape(short)), (f"{unit} {title(part)}", short))
    return found


def title(piece: Piece) -> str:
    """The declaration of an object or member, without what it implements or returns."""
    return piece.text.split("\n", 1)[0].split(" :")[0].removesuffix(" IMPLEMENTS")


PIECES = [(name, kind, text) for (kind, _), (name, text) in pieces().items()]


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "text"), [piece[1:] for piece in PIECES], ids=[piece[0] for piece in PIECES])
def test_it_parses(kind: str, text: str) -> None:
    assert parse_with_blark(text, kind)


@pytest.mark.slow
def test_a_unit_parses_as_it_is_written() -> None:
    trees = parse_text_with_blark(TEXTS[WHOLE], WHOLE)
    assert any(line.startswith("METHOD PUBLIC CartesianToAxes ") for line in trees)


@pytest.mark.slow
def test_all_names_are_names() -> None:
    """None of them is a word of the second grammar."""
    parts = (part for unit, text in TEXTS.items() for piece in split(text, unit) for part in (piece, *piece.members))
    found = sorted(set().union(*(names(part.text) for part in parts)), key=str.lower)
    assert len(found) > 100
    parse_with_blark(declaring(found), "METHOD")


@pytest.mark.parametrize("word", ["and", "end_var", "at"])
def test_a_word_of_the_grammar_would_be_refused(word: str) -> None:
    with pytest.raises(lark.LarkError):
        parse_with_blark(declaring(["headingLength", word]), "METHOD")


def declaring(variables: list[str]) -> str:
    """A method with these variables."""
    lines = "\n".join(f"  {name} : LREAL;" for name in variables)
    return f"METHOD PUBLIC Probe : BOOL\nVAR\n{lines}\nEND_VAR\nProbe := TRUE;\nEND_METHOD"


def test_what_is_the_same_to_a_grammar() -> None:
    text = "IF a > 1.0 THEN\n  RETURN;\nEND_IF\nIF b2 > 20.5E-3 THEN\n  RETURN;\nEND_IF\n"
    text += "x := y;  // so\n\nz := y;  // or so\nx := -y;"
    assert names(text) == {"a", "b2", "x", "y", "z"}
    seen: set[str] = set()
    assert abridged(text, seen) == "IF a > 1.0 THEN\nRETURN;\nEND_IF\nIF n THEN\n;\nEND_IF\nx := y;\n;\nx := -y;"
    assert abridged(text + "\nx := y\n  + x;", seen) == "IF n THEN\n;\nEND_IF\n;\nx := y + x;"
    case = "CASE n OF\n  1: x := 'a';\n  2: x := 'b';\nEND_CASE"
    assert abridged(case, seen) == "CASE n OF\n1: x := 'a';\n2: ;\nEND_CASE"
    assert abridged(case, seen) == "CASE n OF\n1: ;\nEND_CASE"
    values = "A : ARRAY[0..3] OF LREAL :="
    assert abridged(f"{values} [ 1.0, 2.0, -3.0, 4.0 ];", seen) == f"{values} [1.0, 2.0, -3.0];"
