"""The content of a declaration, read from its text: head, pragmas, and every variable with type and comment."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

Attributes = tuple[tuple[str, str], ...]
"""Names and values of pragmas; a pragma without a value has an empty one."""

_PRAGMA = re.compile(r" *\{attribute '([^']*)'(?: := '([^']*)')?\}")
_SECTION = re.compile(r"(VAR\w*|STRUCT)( CONSTANT)?")
_ENDS = ("END_VAR", "END_STRUCT")
_VARIABLE = re.compile(r"  (\w+(?:, \w+)*) : ([^:;]+?)(?: := ([^;]+))?;(?:  // (.*))?")
_HEAD = re.compile(
    r"(?:FUNCTION_BLOCK|FUNCTION|PROGRAM|INTERFACE|METHOD(?: PUBLIC| PRIVATE| PROTECTED)?|PROPERTY(?: PUBLIC)?) \w+"
    r"(?: EXTENDS ([\w.]+))?(?: : (.+)| IMPLEMENTS)?"
)
_ENUMERATOR = re.compile(r"  (\w+)(?: := (\d+))?,?")


@dataclass(frozen=True)
class Variable:
    """A variable; the text of a missing part is empty."""

    name: str
    type: str
    initial: str
    comment: str
    attributes: Attributes


@dataclass(frozen=True)
class Section:
    """A section of variables: its keyword, and whether its variables are constant."""

    scope: str
    is_constant: bool
    variables: tuple[Variable, ...]


@dataclass(frozen=True)
class Declaration:
    """A declaration. A structure has one section; an enumeration has `enumerators` with their numbers."""

    returns: str
    extends: str
    interfaces: tuple[str, ...]
    attributes: Attributes
    sections: tuple[Section, ...]
    enumerators: tuple[tuple[str, int], ...]

    def names(self) -> Iterator[str]:
        """Every name that the declaration declares."""
        yield from (name for name, _ in self.enumerators)
        for section in self.sections:
            yield from (v.name for v in section.variables)


def declaration_of(text: str) -> Declaration:
    """Read a declaration in the form that the compiler writes; raises `ValueError` for a line that it cannot read."""
    lines = _without_comments(text)
    head = next((at for at, line in enumerate(lines) if _HEAD.match(line)), None)
    found = _HEAD.fullmatch(lines[head]) if head is not None else None
    if head is not None and found is None:
        raise ValueError(f"not a head of an object: {lines[head]!r}")
    sections = tuple(_sections(lines))
    return Declaration(
        returns=(found.group(2) or "") if found else "",
        extends=(found.group(1) or "") if found else "",
        interfaces=_interfaces(lines[head or 0 :]),
        attributes=tuple(_attributes([line for line in lines if line.startswith("{")])),
        sections=sections,
        enumerators=() if sections or found else tuple(_enumerators(lines)),
    )


def _without_comments(text: str) -> list[str]:
    """The lines that are no comments. A bracketed comment stands on separate lines.

    A comment with a deeper indent than a declaration continues the comment beside that declaration.
    """
    joined = re.sub(r"// [^\n]*(?:\n {4,}// [^\n]*)+", lambda found: re.sub(r"\n {4,}// ", " ", found[0]), text)
    bare = re.sub(r"^\(\*.*?\*\)$", "", joined, flags=re.DOTALL | re.MULTILINE)
    return [line for line in bare.split("\n") if line and not line.lstrip().startswith("//")]


def _attributes(lines: Sequence[str]) -> Iterator[tuple[str, str]]:
    for line in lines:
        if pragma := _PRAGMA.fullmatch(line):
            yield pragma.group(1), pragma.group(2) or ""


def _interfaces(lines: Sequence[str]) -> tuple[str, ...]:
    if not lines or not lines[0].endswith(" IMPLEMENTS"):
        return ()
    end = next(at for at, line in enumerate(lines) if _SECTION.fullmatch(line))
    return tuple(line.strip(" ,") for line in lines[1:end])


def _sections(lines: Sequence[str]) -> Iterator[Section]:
    starts = [at for at, line in enumerate(lines) if _SECTION.fullmatch(line)]
    for start in starts:
        end = next(at for at in range(start, len(lines)) if lines[at] in _ENDS)
        section = _SECTION.fullmatch(lines[start])
        assert section is not None
        yield Section(section.group(1), section.group(2) is not None, tuple(_variables(lines[start + 1 : end])))


def _variables(lines: Sequence[str]) -> Iterator[Variable]:
    pragmas: list[str] = []
    begun = ""
    for line in lines:
        if _PRAGMA.fullmatch(line):
            pragmas.append(line)
            continue
        begun = f"{begun} {line.strip()}" if begun else line
        if ";" not in begun:
            continue  # an initial value of several lines
        found = _VARIABLE.fullmatch(begun)
        if found is None:
            raise ValueError(f"not a declaration of variables: {begun!r}")
        names, kind, initial, comment = found.groups()
        for name in names.split(", "):
            yield Variable(name, kind, initial or "", comment or "", tuple(_attributes(pragmas)))
        pragmas, begun = [], ""
    if begun:
        raise ValueError(f"not a declaration of variables: {begun!r}")


def _enumerators(lines: Sequence[str]) -> Iterator[tuple[str, int]]:
    number = 0
    for line in lines:
        if found := _ENUMERATOR.fullmatch(line):
            number = int(found.group(2) or number)
            yield found.group(1), number
            number += 1
