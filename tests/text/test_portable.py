"""Every emitted object is in the portable subset; and the lint finds every kind of exception."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import pytest

from tests.codesys.parts import FILES, SAMPLES
from tests.harness import ast, stubs
from tests.harness.contract import INTERFACES
from tests.harness.lexical import SYSTEM, Token, tokens
from tests.harness.names import C_MACROS, KEYWORDS
from tests.harness.parse import parse

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
_EVERY = FILES | {f"samples/{name}.st": text for name, text in SAMPLES.items()}
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


_OWN = parse(FILES["softkin/Softkin_MatrixOrder.st"], "Softkin_MatrixOrder")
LIBRARY = [declared for space, text in stubs.texts(31).items() for declared in parse(text, space)]


@lru_cache
def enumerators() -> dict[str, str]:
    """The enumerators of the libraries and of our own types, with the type that each belongs to."""
    types = [one for one in (*LIBRARY, *_OWN) if isinstance(one, ast.Enumeration)]
    return {name: one.name for one in types for name, _ in one.members}


@lru_cache
def library_names() -> frozenset[str]:
    """What a variable must not hide: namespaces, types and functions of the libraries, in small letters."""
    names = {one.name for one in LIBRARY} | set(INTERFACES) | set(stubs.texts(31)) | {"TRAFO", "SM3M", "SM3_Error"}
    own = {file.split("/")[1].removesuffix(".st") for file in FILES}
    return frozenset(name.lower() for name in names | own)


def lint(text: str) -> list[Violation]:
    """What a text has that is not portable."""
    return violations(text, enumerators(), set(library_names()))


@pytest.mark.parametrize("file", FILES)
def test_every_object_is_portable(file: str) -> None:
    assert lint(FILES[file]) == []


@pytest.mark.parametrize("file", _EVERY)
def test_no_line_is_longer_than_a_page_is_wide(file: str) -> None:
    assert [line for line in _EVERY[file].split("\n") if len(line) > 110] == []


def test_the_lint_knows_enough() -> None:
    assert {"Unknown", "Rotary", "zero", "SMC_NO_ERROR"} <= set(enumerators())
    assert {"trafo", "axispos_ref", "smc_frame", "softkin_root", "ismkinperiodhandling"} <= library_names()


_BODY = "FUNCTION F : LREAL\nVAR\n  x : LREAL;\n  y : LREAL;\nEND_VAR\n\nx := y;\nF := x;\nEND_FUNCTION\n"

PLANTED = {
    "ATAN2": ("x := y;", "x := ATAN2(y, y);", "ATAN2 is not portable"),
    "FLOOR": ("x := y;", "x := FLOOR(y);", "FLOOR is not portable"),
    "EXPT": ("x := y;", "x := EXPT(y, 2);", "EXPT is not portable"),
    "a power": ("x := y;", "x := y**2;", "** is not portable"),
    "AND_THEN": ("x := y;", "IF x > y AND_THEN x > 0.0 THEN", "AND_THEN is not portable"),
    "CONTINUE": ("x := y;", "CONTINUE;", "CONTINUE is not portable"),
    "a loop without an end": ("x := y;", "WHILE x > y DO\nEND_WHILE", "WHILE is not portable"),
    "a reference": ("x : LREAL;", "x : REFERENCE TO LREAL;", "REFERENCE is not portable"),
    "a variable with memory": ("VAR\n", "VAR_STAT\n", "VAR_STAT is not portable"),
    "an address": ("x : LREAL;", "x AT %MD0 : LREAL;", "AT is not portable"),
    "a pointer elsewhere": ("x : LREAL;", "x : POINTER TO LREAL;", "POINTER outside the helpers"),
    "a dereference elsewhere": ("x := y;", "x := y^;", "^ outside the helpers"),
    "an address taken elsewhere": ("x := y;", "x := ADR(y);", "ADR outside the helpers"),
    "small letters": ("x := y;", "if x > y THEN", "capitals"),
    "two underscores": ("x := y;", "x := y__z;", "two underscores"),
    "a query": ("x := y;", "b := __QUERYINTERFACE(x, y);", "__QUERYINTERFACE: two underscores"),
    "the interface of the system": ("x : LREAL;", "x : __SYSTEM.IQueryInterface;", "__SYSTEM: two underscores"),
    "an interface behind something": (
        "END_FUNCTION\n",
        "END_FUNCTION\nINTERFACE I EXTENDS __SYSTEM.IQueryInterface\nEND_INTERFACE\n",
        "INTERFACE is not portable",
    ),
    "a typed literal": ("x := y;", "x := LREAL#1.0;", "typed literal"),
    "an exponent without a point": ("x := y;", "x := 1E9;", "no point"),
    "a number in groups": ("x := y;", "x := 1_000.0;", "underscore"),
    "a bare error": ("x := y;", "x := SMC_NO_ERROR;", "without its type SMC_ERROR"),
    "a bare enumerator": ("x := y;", "IF order = Unknown THEN", "without its type Softkin_MatrixOrder"),
    "an enumerator of another type": ("x := y;", "x := Softkin_MatrixOrder.zero;", "without its type OrientationDOF"),
    "an enumerator of a library": ("x := y;", "IF e = SMC_ERROR.SMC_NO_ERROR THEN", "outside the list of names"),
    "a global variable": ("END_FUNCTION\n", "END_FUNCTION\nVAR_GLOBAL\nEND_VAR\n", "VAR_GLOBAL is not portable"),
    "a bound that is a name": ("x : LREAL;", "x : ARRAY[0..LAST] OF LREAL;", "no literals"),
    "a structured initial value": (
        "x : LREAL;",
        "x : TRAFO.AXISLIMITS := (dLower := 1.0);",
        "structured initial value",
    ),
    "an array of initial values": ("x : LREAL;", "x : ARRAY[0..1] OF LREAL := [1.0, 2.0];", "structured initial value"),
    "a nested comment": ("x := y;", "(* a (* b *) *)", "a comment in a comment"),
    "a comment behind a comment": ("x := y;", "x := y; // a (* b", "a comment in a comment"),
    "a macro of C": ("  y : LREAL;", "  nan : LREAL;", "nan is a name"),
    "a word as a name": ("  y : LREAL;", "  METHOD : LREAL;", "METHOD is a name"),
    "a namespace as a name": ("  y : LREAL;", "  trafo : LREAL;", "trafo is a name"),
    "a type as a name": ("  y : LREAL;", "  Axis_Type : LREAL;", "Axis_Type is a name"),
    "a shared function as a name": ("  y : LREAL;", "  softkin_root : LREAL;", "softkin_root is a name"),
    "a letter that is not ASCII": ("x := y;", "x := y;  // größer", "not ASCII"),
}


@pytest.mark.parametrize("case", PLANTED)
def test_the_lint_sees(case: str) -> None:
    old, new, why = PLANTED[case]
    assert old in _BODY and lint(_BODY) == []
    found = lint(_BODY.replace(old, new, 1))
    assert any(why in one.why for one in found), found


def test_the_head_of_an_interface_alone_names_the_system() -> None:
    """Nothing else in an interface does."""
    text = "INTERFACE I EXTENDS __SYSTEM.IQueryInterface\nMETHOD M\nVAR_INPUT\n  x : LREAL;\nEND_VAR\nEND_METHOD\n"
    assert lint(text) == []
    assert [one.line for one in lint(text.replace("x : LREAL", "x : __SYSTEM.IQueryInterface"))] == [4]
    assert [one.why for one in lint(text.replace("__SYSTEM", "__SYS"))] == ["__SYS: two underscores"]


def test_a_violation_names_its_line() -> None:
    assert [one.line for one in lint(_BODY.replace("x := y;", "x := FLOOR(y);"))] == [7]
