"""Cut a text into objects, and a block into its frame and its members.

Neither grammar parses a block with its methods in every form that is legal in CODESYS (a pragma
before a METHOD, a body before the methods, members at all), but both parse each piece alone.
"""

from dataclasses import dataclass

from .faults import Place, StError
from .lexical import Token, tokens

_OBJECTS = {
    "FUNCTION_BLOCK": "END_FUNCTION_BLOCK", "FUNCTION": "END_FUNCTION", "PROGRAM": "END_PROGRAM",
    "INTERFACE": "END_INTERFACE", "TYPE": "END_TYPE", "VAR_GLOBAL": "END_VAR",
}  # fmt: skip
_HOLDERS = ("FUNCTION_BLOCK", "INTERFACE")
_MEMBERS = {"METHOD": "END_METHOD", "PROPERTY": "END_PROPERTY"}


@dataclass(frozen=True, slots=True)
class Piece:
    """One object or member: its text from the opening keyword on, and what stands before it."""

    kind: str
    text: str
    line: int
    pragmas: tuple[str, ...]
    comment: str
    members: tuple["Piece", ...] = ()


def comment_text(comments: list[str]) -> str:
    plain = (c[2:] if c.startswith("//") else c[2:-2] for c in comments)
    return "\n".join(part.strip() for part in plain).strip()


def split(text: str, file: str) -> list[Piece]:
    return _Splitter(text, file).objects()


class _Splitter:
    def __init__(self, text: str, file: str) -> None:
        self.text = text
        self.file = file
        self.tokens = list(tokens(text))
        self.position = 0
        self.before: list[Token] = []

    def objects(self) -> list[Piece]:
        found = []
        while (token := self._significant()) is not None:
            if token.word in _OBJECTS:
                found.append(self._object(token))
            elif token.text == ";" and found:
                continue  # a semicolon after END_…
            else:
                raise StError(Place(self.file, token.line), f"unexpected {token.text!r} outside an object")
        return found

    def _significant(self) -> Token | None:
        """The next token that is neither comment nor pragma; those are kept in `before`."""
        self.before = []
        while self.position < len(self.tokens):
            token = self.tokens[self.position]
            self.position += 1
            if token.kind not in ("comment", "pragma"):
                return token
            self.before.append(token)
        return None

    def _lead(self) -> tuple[tuple[str, ...], str]:
        pragmas = tuple(t.text for t in self.before if t.kind == "pragma")
        return pragmas, comment_text([t.text for t in self.before if t.kind == "comment"])

    def _object(self, opening: Token) -> Piece:
        pragmas, comment = self._lead()
        closing = _OBJECTS[opening.word]
        members: list[Piece] = []
        frame = ""
        kept_from = opening.start
        while (token := self._significant()) is not None and token.word != closing:
            if opening.word in _HOLDERS and token.word in _MEMBERS:
                lead_start = min([t.start for t in self.before], default=token.start)
                member, end = self._member(token)
                members.append(member)
                # Blank the member but keep its lines, so that line numbers stay right.
                frame += self.text[kept_from:lead_start] + "\n" * self.text.count("\n", lead_start, end)
                kept_from = end
            elif token.word in _OBJECTS and token.word != "VAR_GLOBAL":
                break
        if token is None or token.word != closing:
            raise StError(Place(self.file, opening.line), f"{opening.text} without {closing}")
        frame += self.text[kept_from : token.end]
        return Piece(opening.word, frame, opening.line, pragmas, comment, tuple(members))

    def _member(self, opening: Token) -> tuple[Piece, int]:
        pragmas, comment = self._lead()
        closing = _MEMBERS[opening.word]
        while (token := self._significant()) is not None and token.word != closing:
            if token.word in _MEMBERS or token.word in _OBJECTS:
                break
        if token is None or token.word != closing:
            raise StError(Place(self.file, opening.line), f"{opening.text} without {closing}")
        text = self.text[opening.start : token.end]
        return Piece(opening.word, text, opening.line, pragmas, comment), token.end
