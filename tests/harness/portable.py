"""The portable subset of Structured Text, as a lint: what compiles in one environment only, or reads differently there.

It looks at words alone, so it is independent of the grammar, the type checks and the emitter. What types decide (an
integer where an LREAL is meant, a division of integers, an unqualified error) is refused by `check*.py`.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from .lexical import SYSTEM, Token, tokens
from .names import C_MACROS, KEYWORDS

# Operators, statements and sections that are of one dialect, or mean different things in two of them.
FORBIDDEN = set(
    """
    ATAN2 FLOOR CEIL CEILING EXPT AND_THEN OR_ELSE CONTINUE REFERENCE REF= REF GOTO JMP REPEAT WHILE UNION INTERFACE
    ACTION ABSTRACT FINAL OVERRIDE VAR_INST VAR_TEMP VAR_STAT VAR_GLOBAL VAR_EXTERNAL VAR_ACCESS VAR_CONFIG RETAIN
    PERSISTENT AT XSIZEOF BITADR NEW DELETE TRY CATCH TRUNC_INT
    """.split()
)
_MEMORY = {"POINTER", "ADR"}
"""Words that belong into the helpers that touch the opaque matrix, and nowhere else."""
_HELPERS = {"Softkin_ReadMatrix", "Softkin_WriteMatrix"}
_WORDS = (KEYWORDS | {"GET", "END_GET", "LREAL_TO_INT", "INT_TO_LREAL"}) - {"ERROR"}
_LIBRARY_BOUND = "0..(SM3M.SMC_MAX_VEC_DIM - 1)"
_DECLARED = re.compile(r"^  (\w+) : ([^;]*);")
_SECTION = re.compile(r"^VAR\w*( CONSTANT)?$")


@dataclass(frozen=True)
class Violation:
    """A place that is not portable, and why."""

    line: int
    why: str


def violations(text: str, enumerators: dict[str, str], library_names: set[str]) -> list[Violation]:
    """All of a text. `enumerators` are the types by the enumerator's name, `library_names` those nobody may declare."""
    found = list(tokens(text))
    code = [t for t in found if t.kind not in ("comment", "pragma")]
    problems = [
        *_comments(found),
        *_words(code),
        *_numbers(code),
        *_enumerators(code, enumerators),
        *_declarations(text, library_names),
    ]
    return sorted(problems, key=lambda p: p.line)


def _comments(found: Sequence[Token]) -> Iterator[Violation]:
    for token in found:
        if token.kind == "comment" and re.search(r"\(\*|//|\*\)", token.text[2:].removesuffix("*)").replace("://", "")):
            yield Violation(token.line, "a comment in a comment")
        if not token.text.isascii():
            yield Violation(token.line, "not ASCII")


def _words(code: Sequence[Token]) -> Iterator[Violation]:
    owner = ""
    is_interface = bool(code) and code[0].word == "INTERFACE"
    for before, token in zip([None, *code], code, strict=False):
        word = token.word
        if before is not None and before.word in ("FUNCTION", "FUNCTION_BLOCK"):
            owner = token.text
        is_object = word == "VAR_GLOBAL" and not owner or token is code[0] and is_interface
        if (word in FORBIDDEN and not is_object) or token.kind == "power":
            yield Violation(token.line, f"{token.text} is not portable")
        is_base = token.text == "^" and before is not None and before.word in ("SUPER", "THIS")
        if (word in _MEMORY or token.text == "^") and owner not in _HELPERS and not is_base:
            yield Violation(token.line, f"{token.text} outside the helpers that touch the matrix")
        is_member = before is not None and before.text == "."
        if word in _WORDS and token.text != word and not is_member:
            yield Violation(token.line, f"{token.text}: a word of the language is written in capitals")
        is_extended = is_interface and before is not None and before.word == "EXTENDS"
        if "__" in word and (word, is_extended) != (SYSTEM, True):
            yield Violation(token.line, f"{token.text}: two underscores")
        if token.text in ("#", "%"):
            yield Violation(token.line, f"{token.text}: a typed literal or an address")


def _numbers(code: Sequence[Token]) -> Iterator[Violation]:
    for token in code:
        if token.kind == "number" and re.fullmatch(r"\d+[eE].*", token.text):
            yield Violation(token.line, f"{token.text} has an exponent and no point")
        if token.kind == "number" and "_" in token.text:
            yield Violation(token.line, f"{token.text} has an underscore")


def _enumerators(code: Sequence[Token], enumerators: dict[str, str]) -> Iterator[Violation]:
    """An enumerator stands behind its type, but where the type itself lists it; one of a library in the list of names
    alone.
    """
    inside = ""
    is_list = any(token.word == "VAR_GLOBAL" for token in code)
    for at, token in enumerate(code):
        inside = "TYPE" if token.word == "TYPE" else "" if token.word == "END_TYPE" else inside
        kind = enumerators.get(token.text)
        if kind is None or inside:
            continue
        if at < 2 or code[at - 1].text != "." or code[at - 2].text != kind:
            yield Violation(token.line, f"{token.text} without its type {kind}")
        elif not is_list and not kind.startswith("Softkin_"):
            yield Violation(token.line, f"{token.text} of {kind} outside the list of names")


def _declarations(text: str, library_names: set[str]) -> Iterator[Violation]:
    """Names, array bounds and initial values of variables, which stand one a line."""
    is_inside = False
    for number, line in enumerate(text.split("\n"), start=1):
        is_inside = bool(_SECTION.match(line)) or (is_inside and line != "END_VAR")
        found = _DECLARED.match(line) if is_inside else None
        if found is None:
            continue
        name, rest = found.groups()
        for bounds in re.findall(r"ARRAY\[(.*?)\] OF", rest):
            if bounds != _LIBRARY_BOUND and not re.fullmatch(r"\d+\.\.\d+(, \d+\.\.\d+)*", bounds):
                yield Violation(number, f"the bounds {bounds} are no literals")
        if re.search(r":= *[(\[]", rest) or re.search(r"STRUCT", rest):
            yield Violation(number, f"{name}: a structured initial value")
        if name.upper() in KEYWORDS | C_MACROS or name.lower() in library_names:
            yield Violation(number, f"{name} is a name of the language, of C or of a library")
