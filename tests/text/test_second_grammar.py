"""Every emitted object parses with a second, independent grammar.

It is slow. So what is the same to a grammar is parsed once, phrase by phrase, and all names apart; one unit is parsed
as it is written. That nothing wrong is left out with what is known, faults show that are planted in what is.
"""

from dataclasses import dataclass
from functools import cache

import lark
import pytest

from tests.harness.blark_grammar import parse_text_with_blark, parse_with_blark
from tests.harness.pieces import Piece, split
from tests.text.shapes import Seen, abridged, names, shape
from tests.text.units import FOLDER

pytestmark = pytest.mark.slow

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
    found: dict[tuple[str, str], tuple[str, Written]] = {}
    for unit, text in TEXTS.items():
        for piece in split(text, unit):
            for part in (piece, *piece.members):
                short = abridged(part.text, KNOWN)
                found.setdefault((part.kind, shape(short)), (unit, Written(title(part), part.kind, short)))
    return {unit: tuple(written for at, written in found.values() if at == unit) for unit in TEXTS}


KNOWN = Seen()
"""What `pieces` have read."""


def title(piece: Piece) -> str:
    """The declaration of an object or member, without what it implements or returns."""
    return piece.text.split("\n", 1)[0].split(" :")[0].removesuffix(" IMPLEMENTS")


@pytest.mark.parametrize("unit", TEXTS)
def test_it_parses(unit: str) -> None:
    for piece in pieces()[unit]:
        assert parse_with_blark(piece.text, piece.kind), f"{unit} {piece.title}"


def test_nothing_is_left_out() -> None:
    """Most shapes stand in the first units of the alphabet; every unit has its frame at least."""
    assert sum(map(len, pieces().values())) > 100


def test_a_unit_parses_as_it_is_written() -> None:
    """The independent grammar reads a unit as a whole."""
    trees = parse_text_with_blark(TEXTS[WHOLE], WHOLE)
    assert any(line.startswith("METHOD PROTECTED SolveBranch ") for line in trees)


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
    return f"METHOD PUBLIC Probe : BOOL\nVAR\n  {', '.join(variables)} : LREAL;\nEND_VAR\nProbe := TRUE;\nEND_METHOD"


def test_what_is_the_same_to_a_grammar() -> None:
    """Parts that differ in names and numbers alone count as one part."""
    text = "IF a > 1.0 THEN\n  RETURN;\nEND_IF\nIF b2 > 20.5E-3 THEN\n  RETURN;\nEND_IF\n"
    text += "x := y;  // so\n\nz := y;  // or so\nx := -y;"
    assert names(text) == {"a", "b2", "x", "y", "z"}
    seen = Seen()
    first = "IF a > 1.0 THEN\nRETURN;\nEND_IF\nIF n THEN\n;\nEND_IF\nx := y;\n;\nn := -y;"
    assert abridged(text, seen) == first
    assert abridged(text, seen) == ";"
    assert abridged(text + "\nx := y\n  + x;", seen) == ";\nn := y + x;"
    case = "CASE n OF\n  1: x := 'a';\n  2: x := 'b';\nEND_CASE"
    assert abridged(case, seen) == "CASE n OF\n1: n := 'a';\n2: n := n;\nEND_CASE"
    assert abridged(case, seen) == "CASE n OF\n1: ;\nEND_CASE"
    assert abridged(case, seen) == ";"
    values = "A : ARRAY[0..3] OF LREAL :="
    assert abridged(f"{values} [ 1.0, 2.0, -3.0, 4.0 ];", seen) == f"{values} [1.0, 2.0, -3.0];"


def test_what_is_the_same_of_a_phrase() -> None:
    """A phrase that was seen in parentheses, as an argument or as a whole counts as a name."""
    seen = Seen()
    assert abridged("x := (a + b)*c;", seen) == "x := (a + b) * c;"
    assert abridged("x := (b + (a + b)*c)*(a + b);", seen) == "n := (b + n * n) * (n);"
    assert abridged("y := (b + (a + b)*c)*(c + d);", seen) == "n := n;"
    assert abridged("y := f(s := (a + b)*c, t := a);", seen) == "n := f(s := n * n, t := a);"
    assert abridged("y := g(t := a, s := b[1]) + h.x;", seen) == "n := g(s := b[1]) + h.x;"
    assert abridged("IF f(s := a, t := b) THEN", seen) == "IF f(s := n, t := n) THEN"
    assert abridged("IF f(u := a[2], t := b, s := a*b) THEN", seen) == "IF f(u := n, t := n, s := a * b) THEN"


WRONG = (
    "x := (y + z;",
    "x := y + ;",
    "x := y z;",
    "x := y + * z;",
    "x := (y + z)*f(a := (y + ), b := z);",
    "x := f(y z);",
    "x := y[1;",
    "x := y[];",
    "x := NOT;",
    "x := y AND (z OR );",
    "x := y.;",
    "x := 1.0E;",
    "x := VAR;",
    "x := (END_IF + y)*z;",
    "x := y END_IF;",
    "x =: y;",
    "x + y;",
    "IF x > THEN\nEND_IF",
    "IF THEN\nx := y;\nEND_IF",
    "IF x THEN\nx := y;",
    "x := y;\nEND_IF",
    "IF x THEN\nx := y;\nEND_FOR",
    "IF x THEN\nELSE\nELSE\nEND_IF",
    "FOR x := 1 DO\nx := y;\nEND_FOR",
    "FOR 1 TO 2 DO\nx := y;\nEND_FOR",
    "FOR x := 1 TO 2*(y + ) DO\nx := y;\nEND_FOR",
    "CASE x OF\n  1: y := x;\n  z: x := y z;\nEND_CASE",
)
"""Statements that are wrong, of phrases that are right elsewhere."""


@pytest.mark.parametrize("wrong", WRONG)
def test_a_wrong_statement_is_left(wrong: str) -> None:
    """However much is known, what is left of it does not parse, whether it stands alone or in another statement."""
    pieces()
    for statements in (wrong, f"IF x THEN\ny := x;\n{wrong}\nEND_IF"):
        known = Seen(set(KNOWN.shapes), set(KNOWN.phrases))
        short = abridged(f"METHOD PUBLIC Probe : BOOL\n{statements}\nProbe := TRUE;\nEND_METHOD", known)
        with pytest.raises(lark.LarkError):
            parse_with_blark(short, "METHOD")


def test_a_right_statement_is_not() -> None:
    """Nothing is left of a statement whose phrases are all known."""
    pieces()
    right = "IF x THEN\ny := f(a := x, b := -y);\nEND_IF"
    short = abridged(f"METHOD PUBLIC Probe : BOOL\n{right}\nProbe := TRUE;\nEND_METHOD", KNOWN)
    assert short == "METHOD PUBLIC Probe : BOOL\n;\nEND_METHOD"
