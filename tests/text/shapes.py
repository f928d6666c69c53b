"""The shape of a text for a grammar: names and numbers do not matter, and a shape is parsed once."""

import re
from dataclasses import dataclass, field

from tests.text.phrases import Keys, shortened

_WORDS = re.compile(r"//[^\n]*|'[^'\n]*'|\b\d[\d.]*(?:E-?\d+)?\b|\b[A-Za-z_]\w*\b")
_ALONE = re.compile(r"VAR|STRUCT|METHOD|FUNCTION|PROPERTY|TYPE|GET|END_|\{|TRAFO\.")
"""How lines begin that are no part of a statement."""
_ENDS = (";", "THEN", "ELSE", "DO", "OF", ":")
_VARIABLE = re.compile(r"\w+ : [^;]*;")
_VALUES = re.compile(r":= \[ ?([^\[\]]*?) ?\];")
_LABEL = re.compile(r"(\d+): (.*;)")
"""A statement of a CASE: without it, there must be another."""
_CONDITION = re.compile(r"(IF|ELSIF) .*THEN")
_OPENED, _CLOSED = ("IF ", "FOR ", "CASE ", "WHILE "), ("END_IF", "END_FOR", "END_CASE", "END_WHILE")
_LONGEST_GROUP = 8
"""Lines in a group that may repeat: a condition with its refusal, a choice between two assignments."""


@dataclass
class Seen:
    """What a grammar has read: shapes of lines and of statements with a body, and phrases."""

    shapes: set[str] = field(default_factory=set)
    phrases: Keys = field(default_factory=set)


def shape(text: str) -> str:
    """The text with every name, number, string and comment made the same; keywords and types stay."""
    return _WORDS.sub(lambda match: _same(match[0]), text)


def names(text: str) -> set[str]:
    return {match[0] for match in _WORDS.finditer(text) if _same(match[0]) == "n"}


def abridged(text: str, seen: Seen) -> str:
    """The text without what has a shape that is in `seen`, and the new shapes are then in it.

    Phrases of a statement that are known are shortened. Variables are left out, an empty statement stands for a
    statement, or for one with a body (IF, FOR, CASE) that is known, a name for a condition. Lines, or groups of
    lines, that repeat the shape of those before them are left out too, and comments, and in a list of values those of
    the shape of two others.
    """
    found: list[str] = []
    for statement in _statements(text):
        line = _VALUES.sub(_few, statement)
        if not (_ALONE.match(line) or _VARIABLE.fullmatch(line)):
            label = _LABEL.fullmatch(line)
            line = f"{label[1]}: {shortened(label[2], seen.phrases)}" if label else shortened(line, seen.phrases)
        is_old = shape(line) in seen.shapes
        if not is_old or _ALONE.match(line):
            found.append(line)
        elif condition := _CONDITION.fullmatch(line):
            found.append(f"{condition[1]} n THEN")
        elif label := _LABEL.fullmatch(line):
            found.append(f"{label[1]}: ;")
        elif not _VARIABLE.fullmatch(line):
            found.append(";" if line.endswith(";") else line)
        seen.shapes.add(shape(line))
        _fold(found, seen)
    return _condensed(found)


def _fold(lines: list[str], seen: Seen) -> None:
    """Where the last line ends a statement with a body whose shape is known, an empty statement instead."""
    if not lines or lines[-1] not in _CLOSED:
        return
    depth, place = 1, len(lines) - 1
    while depth and place:
        place -= 1
        depth += (lines[place] in _CLOSED) - lines[place].startswith(_OPENED)
    if depth:
        return
    whole = _condensed(lines[place:])
    lines[place:] = [";"] if shape(whole) in seen.shapes else whole.split("\n")
    seen.shapes.add(shape(whole))


def _statements(text: str) -> list[str]:
    """The text with every statement, variable and condition on a line of its own."""
    found: list[str] = []
    begun = ""
    for code in filter(None, (line.split("//")[0].strip() for line in text.split("\n"))):
        if _ALONE.match(code):
            found += [begun, code]
            begun = ""
            continue
        begun = f"{begun} {code}".strip()
        if begun.endswith(_ENDS):
            found.append(begun)
            begun = ""
    return list(filter(None, [*found, begun]))


def _few(values: re.Match[str]) -> str:
    kept: list[str] = []
    for value in values[1].split(", "):
        if sum(shape(value) == shape(other) for other in kept) < 2:
            kept.append(value)
    return f":= [{', '.join(kept)}];"


def _condensed(given: list[str]) -> str:
    lines: list[str] = []
    shapes: list[str] = []
    for line in given:
        lines.append(line)
        shapes.append(shape(line))
        for size in range(1, _LONGEST_GROUP + 1):
            if shapes[-size:] == shapes[-2 * size : -size] and _is_balanced(shapes[-size:]):
                del lines[-size:], shapes[-size:]
                break
    return "\n".join(lines)


def _is_balanced(group: list[str]) -> bool:
    """Whether as many blocks begin as end in some lines, and no ELSE is of a block outside."""
    depth = 0
    for line in group:
        depth += line.startswith((*_OPENED, "VAR")) - line.startswith("END_")
        if depth < 0 or (line == "ELSE" and depth == 0):
            return False
    return depth == 0


def _same(word: str) -> str:
    if word.startswith("//"):
        return "//"
    if word.startswith("'"):
        return "''"
    if word[0].isdigit():
        return "0"
    return word if word.isupper() and len(word) > 1 else "n"
