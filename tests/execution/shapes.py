"""What a text is to a grammar: which names and numbers stand in it does not matter, nor what has been parsed before."""

from __future__ import annotations

import re

_WORDS = re.compile(r"//[^\n]*|'[^'\n]*'|\b\d[\d.]*(?:E-?\d+)?\b|\b[A-Za-z_]\w*\b")
_VARIABLE = re.compile(r"\w+ : [^;]*;\s*(//.*)?")
_ASSIGNMENT = re.compile(r"[^;]*:=[^;]*;\s*(//.*)?")
_BEFORE_A_STATEMENT = (";", "THEN", "ELSE", "DO", "END_IF", "END_FOR", "END_VAR")
_LONGEST_GROUP = 8
"""Lines in a group that may repeat: a condition with its refusal, a choice between two assignments."""


def shape(text: str) -> str:
    """The text with every name, number, string and comment made the same; keywords and types stay."""
    return _WORDS.sub(lambda match: _same(match[0]), text)


def names(text: str) -> set[str]:
    """Every name in a text."""
    return {match[0] for match in _WORDS.finditer(text) if _same(match[0]) == "n"}


def abridged(text: str, seen: set[str]) -> str:
    """The text without variables and assignments of a shape that is in `seen`, and the new ones are then in it.

    An empty statement stands for an assignment. Lines, or groups of lines, that repeat the shape of those before them
    are left out too.
    """
    lines: list[str] = []
    before = ""
    for line in map(str.strip, text.split("\n")):
        code = line.split("//")[0].rstrip()
        if not code:
            continue
        is_variable, is_assignment = _VARIABLE.fullmatch(line), _ASSIGNMENT.fullmatch(line)
        if is_variable or (is_assignment and before.endswith(_BEFORE_A_STATEMENT)):
            is_old = shape(line) in seen
            seen.add(shape(line))
            line = "" if is_old and is_variable else ";" if is_old else line
        lines.append(line)
        before = code
    return _condensed(list(filter(None, lines)))


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
    """Whether as many blocks begin as end in some lines."""
    begins = sum(line.startswith(("IF ", "FOR ", "CASE ", "VAR")) for line in group)
    return begins == sum(line.startswith("END_") for line in group)


def _same(word: str) -> str:
    if word.startswith("//"):
        return "//"
    if word.startswith("'"):
        return "''"
    if word[0].isdigit():
        return "0"
    return word if word.isupper() and len(word) > 1 else "n"
