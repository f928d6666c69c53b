"""Every emitted object parses with a second, independent grammar.

It is slow. So what is the same to a grammar is parsed once, and all names apart; one unit is parsed as it is written.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import lark
import pytest

from tests.harness.blark_grammar import parse_text_with_blark, parse_with_blark
from tests.harness.pieces import Piece, split
from tests.text.shapes import Seen, abridged, names, shape
from tests.text.units import FOLDER

TEXTS = {path.stem: path.read_text(encoding="utf-8") for path in sorted(FOLDER.glob("*/*.st"))}
WHOLE = "Softkin_Gantry2"


@dataclass(frozen=True)
class Written:
    """An object or member as the second grammar reads it."""

    title: str
    kind: str
    text: str


@cache
def pieces() -> dict[str, tuple[Written, ...]]:
    """The first object or member of every kind and shape, by the unit in which it stands."""
    seen = Seen()
    found: dict[tuple[str, str], tuple[str, Written]] = {}
    for unit, text in TEXTS.items():
        for piece in split(text, unit):
            for part in (piece, *piece.members):
                short = abridged(part.text, seen)
                found.setdefault((part.kind, shape(short)), (unit, Written(title(part), part.kind, short)))
    return {unit: tuple(written for at, written in found.values() if at == unit) for unit in TEXTS}


def title(piece: Piece) -> str:
    """The declaration of an object or member, without what it implements or returns."""
    return piece.text.split("\n", 1)[0].split(" :")[0].removesuffix(" IMPLEMENTS")


@pytest.mark.slow
@pytest.mark.parametrize("unit", TEXTS)
def test_it_parses(unit: str) -> None:
    for piece in pieces()[unit]:
        assert parse_with_blark(piece.text, piece.kind), f"{unit} {piece.title}"


def test_nothing_is_left_out() -> None:
    """Most shapes stand in the first units of the alphabet; every unit has its frame at least."""
    assert sum(map(len, pieces().values())) > 250


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
    seen = Seen()
    assert abridged(text, seen) == "IF a > 1.0 THEN\nRETURN;\nEND_IF\nIF n THEN\n;\nEND_IF\nx := y;\n;\nx := -y;"
    assert abridged(text + "\nx := y\n  + x;", seen) == "IF n THEN\n;\nEND_IF\n;\nx := y + x;"
    case = "CASE n OF\n  1: x := 'a';\n  2: x := 'b';\nEND_CASE"
    assert abridged(case, seen) == "CASE n OF\n1: x := 'a';\n2: ;\nEND_CASE"
    assert abridged(case, seen) == "CASE n OF\n1: ;\nEND_CASE"
    values = "A : ARRAY[0..3] OF LREAL :="
    assert abridged(f"{values} [ 1.0, 2.0, -3.0, 4.0 ];", seen) == f"{values} [1.0, 2.0, -3.0];"
