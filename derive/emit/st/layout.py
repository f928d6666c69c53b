"""The layout of Structured Text: indents, and breaks in long statements where they read well."""

from __future__ import annotations

import re
from collections.abc import Sequence
from textwrap import wrap

from derive.emit.braced import broken, indented

WIDTH = 110
_INDENT = "  "
INSIDE = len(_INDENT)
"""The columns that an indent takes from a line inside an IF."""
_CALL = re.compile(r"\w+\([^()]*\)")
_PLAIN_WORD = re.compile(r"[a-z]+\b")
"""A word that is no name, so that it may begin a sentence with a capital letter."""
_LOCALS = re.compile(r"^VAR\n(.*?)^END_VAR", re.DOTALL | re.MULTILINE)
_LOCAL = re.compile(r"  (\w+) : ([^:;]+);")
_LONG_CONDITION = 45
_LEAST_COMMENT = 30
"""The fewest columns of a comment beside a declaration."""
_LONGEST = 255


def quoted(text: str) -> str:
    """A text as a literal, with no more characters than a STRING may have."""
    return "'" + text[:_LONGEST].replace("$", "$$").replace("'", "$'") + "'"


def harmless(comment: str) -> str:
    """A comment without the marks that begin and end comments."""
    return comment.replace("(*", "( *").replace("*)", "* )")


def wrapped(statement: str, width: int = WIDTH - INSIDE) -> list[str]:
    """The lines of a statement, broken where it is too wide."""
    return list(broken(statement, width))


def packed(pieces: Sequence[str], width: int = WIDTH - 10) -> list[str]:
    """Lines of several short pieces each; they leave room for an indent."""
    lines: list[str] = []
    for piece in pieces:
        if lines and len(lines[-1]) + 1 + len(piece) <= width:
            lines[-1] += f" {piece}"
        else:
            lines.append(piece)
    return lines


def assigned(target: str, value: str) -> str:
    """The lines of `target := value;`."""
    return "\n".join(wrapped(f"{target} := {value};"))


def conjunction(head: str, parts: Sequence[str], tail: str) -> list[str]:
    """The lines of `head (first) AND (second) tail`; long conditions get a line each."""
    if len(parts) == 1:
        return wrapped(f"{head}{parts[0]}{tail}")
    bracketed = [part if _CALL.fullmatch(part) else f"({part})" for part in parts]
    whole = f"{head}{' AND '.join(bracketed)}{tail}"
    if len(whole) <= WIDTH - INSIDE or max(map(len, bracketed)) <= _LONG_CONDITION:
        return wrapped(whole)
    first, *others = bracketed
    *lines, last = [head + first, *(f"{2 * _INDENT}AND {part}" for part in others)]
    return [piece for line in (*lines, last + tail) for piece in wrapped(line)]


def commented(lines: Sequence[str], comment: str, width: int = WIDTH - INSIDE) -> list[str]:
    """The lines with a comment beside the last one, or above the first one if there is no room."""
    if not comment:
        return list(lines)
    comment = harmless(comment)
    if len(lines) == 1 and len(f"{lines[0]}  // {comment}") <= width:
        return [f"{lines[0]}  // {comment}"]
    return [*wrap(sentence(comment), width, initial_indent="// ", subsequent_indent="// "), *lines]


def sentence(comment: str) -> str:
    """The comment with a capital letter where it begins with a word that is no name."""
    return comment[0].upper() + comment[1:] if _PLAIN_WORD.match(comment) else comment


def beside(declaration: str, comment: str) -> list[str]:
    """A declaration with its comment beside it; a long comment continues on further lines."""
    if not comment:
        return [declaration]
    margin = " " * (len(declaration) + 2 + len(declaration) % 2)
    first, *others = wrap(harmless(comment), max(WIDTH - len(margin) - 3 - INSIDE, _LEAST_COMMENT))
    return [f"{declaration}  // {first}", *(f"{margin}// {line}" for line in others)]


def gathered(declarations: Sequence[tuple[str, str]]) -> list[str]:
    """Variables with their types, those of one type together: `a1, a2 : LREAL;`, in as many lines as they need."""
    lines: list[str] = []
    for kind in dict.fromkeys(kind for _, kind in declarations):
        own = [name for name, other in declarations if other == kind]
        room = WIDTH - INSIDE - len(f" : {kind};")
        names = ""
        for name in own:
            if names and len(f"{names}, {name}") > room:
                lines.append(f"{names} : {kind};")
                names = ""
            names = f"{names}, {name}" if names else name
        lines.append(f"{names} : {kind};")
    return lines


def with_gathered(text: str) -> str:
    """A method with its local variables gathered by their types."""

    def section(found: re.Match[str]) -> str:
        lines = [line for line in found[1].split("\n") if line.strip()]
        plain = [_LOCAL.fullmatch(line) for line in lines]
        if not all(plain):
            return found[0]
        declarations = [(one[1], one[2]) for one in plain if one]
        return "\n".join(["VAR", *indented(gathered(declarations)), "END_VAR"])

    return _LOCALS.sub(section, text)


def case(label: int, target: str, text: str) -> list[str]:
    """The lines of `label: target := 'text';`. A long text gets a line of its own, because it cannot be broken."""
    head, value = f"{label}:", f"{quoted(text)};"
    if len(f"{head} {target} := {value}") <= WIDTH - INSIDE:
        return [f"{head} {target} := {value}"]
    if len(f"{target} := {value}") <= WIDTH - 2 * INSIDE:
        return [head, f"{_INDENT}{target} := {value}"]
    return [head, f"{_INDENT}{target} :=", f"{2 * _INDENT}{value}"]


def tidy(text: str) -> str:
    """The text without empty sections, and with at most one empty line between paragraphs."""
    text = re.sub(r"\n(VAR\n)\s*\n", r"\n\1", "\n" + text)
    text = re.sub(r"\n\s*\n(END_VAR|END_IF|END_FOR)", r"\n\1", text)
    text = re.sub(r"\nVAR\nEND_VAR(?=\n)", "", text)
    text = re.sub(r"\n{3,}", "\n\n", text)
    return text.strip("\n") if text.lstrip("\n").startswith("VAR") else "\n" + text.strip("\n")
