"""Long statements over several lines: broken inside brackets, at the loosest operator."""

from __future__ import annotations

WIDTH = 110
_CLOSING = {"(": ")", "[": "]"}
_LOOSEST_FIRST: tuple[tuple[str, ...], ...] = (
    (", ",),
    (" if ", " else "),
    (" or ", " | "),
    (" and ", " & "),
    (" + ", " - "),
    ("*", "/"),
)


def fold(line: str, indent: int = 0) -> list[str]:
    """A statement as lines of at most `WIDTH` characters, where it can be broken at all."""
    text = " " * indent + line
    if len(text) <= WIDTH:
        return [text]
    opening = _widest_bracket(_bracketed(line))
    if opening is None:
        return [text]
    line = _bracketed(line)
    closing = _partner(line, opening)
    lines = [" " * indent + line[: opening + 1]]
    pieces = _pieces(line[opening + 1 : closing])
    if not line.startswith("from "):
        pieces = _packed(pieces, WIDTH - indent - 4)
    for piece in pieces:
        lines.extend(fold(piece, indent + 4))
    return [*lines, " " * indent + line[closing:]]


def packed(pieces: list[str]) -> list[str]:
    """Short pieces together on lines of the usual width."""
    return _packed(pieces, WIDTH - 8)


def tuple_of(parts: list[str]) -> str:
    """Expressions as a tuple."""
    return f"({', '.join(parts)}{',' if len(parts) == 1 else ''})"


def repeated(part: str, count: int) -> str:
    """A tuple of that many equal expressions."""
    return f"{count}*({part},)" if count > 1 else f"({part},)"


def taken_apart(targets: list[str], source: str) -> list[str]:
    """`a, b, c = source`, in as many lines as it takes."""
    line = f"{', '.join(targets)} = {source}" if len(targets) > 1 else f"({targets[0]},) = {source}"
    if len(line) <= WIDTH:
        return [line]
    return ["(", *(f"    {part}" for part in packed([f"{t}," for t in targets])), f") = {source}"]


def _packed(pieces: list[str], width: int) -> list[str]:
    """Short pieces together on a line; the arms of a choice and the rows of a matrix stay apart."""
    if any(piece.startswith(("if ", "((", "(-", "(0", "(1")) or piece.endswith("),") for piece in pieces):
        return pieces
    lines = pieces[:1]
    for piece in pieces[1:]:
        joint = "" if piece.startswith(("*", "/")) and piece != "*," else " "
        if len(lines[-1]) + len(joint) + len(piece) <= width:
            lines[-1] += joint + piece
        else:
            lines.append(piece)
    return lines


def _bracketed(line: str) -> str:
    """The statement with its right-hand side in brackets, so that it may be broken there."""
    for head in ("return ", *_assignment(line)):
        rest = line[len(head) :]
        if line.startswith(head) and not _is_one_bracket(rest):
            return f"{head}({rest})"
    return line


def _bracketed_argument(text: str) -> str:
    keyword, equals, value = text.partition("=")
    head = keyword + equals if keyword.isidentifier() and equals else ""
    return text if _is_one_bracket(text[len(head) :]) else f"{head}({text[len(head) :]})"


def _assignment(line: str) -> tuple[str, ...]:
    if line.startswith("from "):
        return (line[: line.index(" import ") + len(" import ")],)
    name, equals, _ = line.partition(" = ")
    return (name + equals,) if equals and "(" not in name else ()


def _is_one_bracket(text: str) -> bool:
    """Whether a call or a bracket is the whole text."""
    start = next((i for i, c in enumerate(text) if c in _CLOSING), None)
    if start is None or not (start == 0 or text[:start].replace(".", "_").isidentifier()):
        return False
    return _partner(text, start) == len(text) - 1


def _widest_bracket(line: str) -> int | None:
    """Where the widest outermost bracket opens."""
    found: dict[int, int] = {}
    at = 0
    while at < len(line):
        if line[at] in _CLOSING:
            end = _partner(line, at)
            found[at] = end - at
            at = end
        at = _after_string(line, at) if line[at] == '"' else at + 1
    wide = {start: size for start, size in found.items() if size > 1}
    return max(wide, key=lambda start: wide[start]) if wide else None


def _partner(line: str, opening: int) -> int:
    """Where the bracket that opens at `opening` closes."""
    depth, at = 0, opening
    while True:
        if line[at] == '"':
            at = _after_string(line, at)
            continue
        depth += (line[at] in _CLOSING) - (line[at] in _CLOSING.values())
        if depth == 0:
            return at
        at += 1


def _after_string(line: str, quote: int) -> int:
    at = quote + 1
    while line[at] != '"':
        at += 2 if line[at] == "\\" else 1
    return at + 1


def _pieces(content: str) -> list[str]:
    """What stands in a bracket, cut at its loosest operator: after a comma, before anything else."""
    for separators in _LOOSEST_FIRST:
        cuts = [c for c in _outermost(content, separators) if c > 0]
        if not cuts:
            continue
        if separators == (", ",):
            parts = [content[a:b].strip(" ,") for a, b in zip([0, *(c + 1 for c in cuts)], [*cuts, len(content)], strict=True)]
            return [f"{part if len(part) < WIDTH - 12 else _bracketed_argument(part)}," for part in parts if part]
        return [content[a:b].strip() for a, b in zip([0, *cuts], [*cuts, len(content)], strict=True)]
    return [content]


def _outermost(content: str, separators: tuple[str, ...]) -> list[int]:
    """Where one of the separators stands outside all brackets and strings."""
    cuts, depth, at = [], 0, 0
    while at < len(content):
        if content[at] == '"':
            at = _after_string(content, at)
            continue
        depth += (content[at] in _CLOSING) - (content[at] in _CLOSING.values())
        if depth == 0 and content.startswith(separators, at):
            cuts.append(at)
        at += 1
    return cuts
