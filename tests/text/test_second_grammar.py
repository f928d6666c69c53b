"""Every emitted object parses with a second, independent grammar.

It is slow. So what is the same to a grammar is parsed once, phrase by phrase, and all names apart; one unit is parsed
as it is written. That nothing wrong is left out with what is known, faults show that are planted in what is.
"""

from functools import cache

import lark
import pytest

from tests.harness.blark_grammar import parse_text_with_blark, parse_with_blark
from tests.harness.pieces import Piece, split
from tests.text.shapes import method, names, shapes
from tests.text.units import FOLDER

pytestmark = pytest.mark.slow

TEXTS = {path.stem: path.read_text(encoding="utf-8") for path in sorted(FOLDER.glob("*/*.st"))}
WHOLE = "Softkin_Gantry2"
AS_WRITTEN = ("TYPE", "VAR_GLOBAL", "INTERFACE")
"""Kinds of which there are a few short ones."""


def parts_of(unit: str) -> list[Piece]:
    return [part for piece in split(TEXTS[unit], unit) for part in (piece, *piece.members)]


@cache
def pieces() -> dict[tuple[str, str], str]:
    """Every kind and shape, with the unit in which it stands first."""
    found: dict[tuple[str, str], str] = {}
    for unit in TEXTS:
        for part in parts_of(unit):
            frame, statements = (part.text, set[str]()) if part.kind in AS_WRITTEN else shapes(part.text)
            for at in ((part.kind, frame), *(("METHOD", statement) for statement in sorted(statements))):
                found.setdefault(at, unit)
    return found


def test_it_parses() -> None:
    assert len(pieces()) > 200
    for (kind, text), unit in pieces().items():
        assert parse_with_blark(text, kind), unit


def test_a_unit_parses_as_it_is_written() -> None:
    """The independent grammar reads a unit as a whole."""
    trees = parse_text_with_blark(TEXTS[WHOLE], WHOLE)
    assert any(line.startswith("METHOD PROTECTED SolveBranch ") for line in trees)


def test_all_names_are_names() -> None:
    """None of them is a word of the second grammar."""
    found = sorted(set().union(*(names(part.text) for unit in TEXTS for part in parts_of(unit))), key=str.lower)
    assert len(found) > 100
    parse_with_blark(declaring(found), "METHOD")


@pytest.mark.parametrize("word", ["and", "end_var", "at"])
def test_a_word_of_the_grammar_would_be_refused(word: str) -> None:
    with pytest.raises(lark.LarkError):
        parse_with_blark(declaring(["headingLength", word]), "METHOD")


def declaring(variables: list[str]) -> str:
    """A method with these variables."""
    return method(f"VAR\n  {', '.join(variables)} : LREAL;\nEND_VAR\nProbe := TRUE;")


def test_what_is_the_same_to_a_grammar() -> None:
    right = (
        "IF a > 1.0 THEN\n  RETURN;\nEND_IF\nx := y[1] + f(s := (b2 + c.d)*2);  // so\nz := -y + f(s := e, t := 'a');"
    )
    assert names(right) == {"a", "x", "y", "f", "s", "b2", "c", "d", "z", "e", "t"}
    frame, statements = shapes(method(f"VAR\n  a, x, y, z : LREAL;\nEND_VAR\n{right}"))
    assert frame == "METHOD n : BOOL\nVAR\nEND_VAR\n;\nEND_METHOD"
    assert sorted(s.split("\n", 1)[1].removesuffix("\nEND_METHOD") for s in statements) == [
        "IF n THEN ; END_IF ;", "RETURN ;", "VAR\nn , n , n : LREAL ;\nEND_VAR", "n := '' ;", "n := ( n ) ;",
        "n := - n ;", "n := 0 ;", "n := 0.0 ;", "n := n ( n := n ) ;", "n := n ( n := n , n := n ) ;", "n := n * n ;",
        "n := n + n ;", "n := n ;", "n := n > n ;", "n := n [ n ] ;", "n := n.n ;",
    ]  # fmt: skip


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
    "x + y := z;",
    "f(x) := z;",
    "2 := z;",
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
    "VAR\n  x : LREAL = 1.0;\nEND_VAR",
    "VAR\n  x, : LREAL;\nEND_VAR",
)
"""What is wrong, of phrases that are right elsewhere."""


@pytest.mark.parametrize("wrong", WRONG)
def test_what_is_wrong_is_left(wrong: str) -> None:
    """However much is known, what is left of it does not parse, whether it stands alone or in another statement."""
    known = {text for _, text in pieces()}
    for statements in (wrong, f"IF x THEN\ny := x;\n{wrong}\nEND_IF"):
        frame, shorter = shapes(method(f"{statements}\nProbe := TRUE;"))
        with pytest.raises(lark.LarkError):
            for text in {frame, *shorter} - known:
                parse_with_blark(text, "METHOD")
