"""Words of a text: what is refused by name alone, and where objects and their members begin and end."""

import re
from functools import lru_cache
from typing import NamedTuple

from .faults import Place, StError

_TOKEN = re.compile(
    r"(?P<comment>\(\*.*?\*\)|//[^\n]*)"
    r"|(?P<pragma>\{[^}]*\})"
    r"|(?P<string>'(?:\$.|[^'$])*')"
    r"|(?P<word>[A-Za-z_]\w*)"
    r"|(?P<number>\d[\d_]*(?:\.\d+)?(?:[eE][+-]?\d+)?)"
    r"|(?P<power>\*\*)"
    r"|(?P<other>\S)",
    re.DOTALL,
)

# These exist in some dialects only, or mean different things in them.
REFUSED_WORDS = {
    "AND_THEN", "OR_ELSE", "CONTINUE", "REFERENCE", "ATAN2", "FLOOR", "CEIL", "EXPT", "JMP", "REPEAT", "GOTO",
    "UNION", "VAR_STAT", "VAR_INST", "VAR_TEMP",
}  # fmt: skip
QUERY = "__QUERYINTERFACE"
"""The operator that finds an interface of an object: for programs of a user, beyond the portable subset."""
SYSTEM = "__SYSTEM"
"""The namespace of the interface that a query needs: the head of an interface alone names it."""


class Token(NamedTuple):
    kind: str
    text: str
    start: int
    end: int
    line: int
    word: str
    """In capital letters; empty where it is none."""


@lru_cache(maxsize=4)
def tokens(text: str) -> tuple[Token, ...]:
    """All words of a text; it is read twice, for words that are refused and for where its objects end."""
    found, line, last = [], 1, 0
    for match in _TOKEN.finditer(text):
        start, end = match.span()
        line += text.count("\n", last, start)
        last = start
        kind, part = str(match.lastgroup), match.group()
        found.append(Token(kind, part, start, end, line, part.upper() if kind == "word" else ""))
    return tuple(found)


def refuse_words(text: str, file: str) -> None:
    """Raise StError for what the dialect excludes whatever its place."""
    head = 0
    for token in tokens(text):
        word = token.word
        if word:
            head = token.line if word == "INTERFACE" else head
            if word in REFUSED_WORDS:
                raise StError(Place(file, token.line), f"{token.text} is not part of the dialect")
            if "__" in word and word != QUERY and (word != SYSTEM or token.line != head):
                raise StError(Place(file, token.line), f"double underscore in the name {token.text}")
        elif token.kind == "comment" and "(*" in token.text[2:] and token.text[0] == "(":
            raise StError(Place(file, token.line), "nested comment")
        elif token.kind == "power":
            raise StError(Place(file, token.line), "the operator ** is not part of the dialect")
