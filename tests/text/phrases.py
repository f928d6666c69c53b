"""The phrases of a statement: what a grammar has read once, in all its parts, is left out.

To a context-free grammar a bracketed expression, an argument, an operand are each the same wherever they stand. So what
counts is which operator stands between operands of which kinds, which kinds of arguments, indices and sides of an
assignment there are; an expression of which all this is known gives way to the shortest of its kind.
"""

import re
from dataclasses import dataclass

_TOKENS = re.compile(r"'[^'\n]*'|\d[\d.]*(?:E-?\d+)?|[A-Za-z_]\w*|:=|=>|<=|>=|<>|\S")
_BETWEEN = {"IF", "THEN", "ELSIF", "FOR", "TO", "BY", "DO", "WHILE", "CASE", "OF", ":=", ";", ":"}
"""What stands between the expressions of a statement."""
_LEVELS = (("OR",), ("XOR",), ("AND",), ("=", "<>"), ("<", "<=", ">", ">="), ("+", "-"), ("*", "/", "MOD"))
"""The operators, those that bind least first."""


@dataclass(frozen=True)
class Phrase:
    """An expression: its text without what is known, and the shortest text of its kind."""

    text: str
    short: str
    kind: str
    is_known: bool

    @property
    def written(self) -> str:
        """What stands for it where it is part of something new."""
        return self.short if self.is_known else self.text


Keys = set[tuple[str, ...]]


def shortened(statement: str, seen: Keys) -> str:
    """A statement without the phrases in `seen`, and its new ones are then in it; as it is where it is no statement of
    expressions.
    """
    tokens = _TOKENS.findall(statement)
    found: list[str] = []
    before, start, depth = "", 0, 0
    for place, token in enumerate(tokens):
        depth += (token in "([") - (token in ")]")
        if token not in _BETWEEN or depth:
            continue
        if place > start:
            part = _segment(tokens[start:place], before, token, seen)
            if part is None:
                return statement
            found.append(part)
        found.append(token)
        before, start = token, place + 1
    return _spaced(found) if start == len(tokens) else statement


def _segment(tokens: list[str], before: str, after: str, seen: Keys) -> str | None:
    """What stands for an expression between two words."""
    reader = _Reader(tokens, seen)
    phrase = reader.chain(0)
    if phrase is None or reader.place < len(tokens):
        return None
    is_known = reader.learn((before, phrase.kind, after))
    if phrase.is_known and is_known:
        return phrase.short if (before, after) == ("", ";") else "n"  # a call, RETURN, EXIT
    return phrase.written


def _spaced(parts: list[str]) -> str:
    return " ".join(parts).replace(" ;", ";").replace(" :", ":").replace(":=", " :=").replace("  ", " ")


class _Reader:
    def __init__(self, tokens: list[str], seen: Keys) -> None:
        self.tokens, self.place, self.seen = tokens, 0, seen

    def learn(self, *keys: tuple[str, ...]) -> bool:
        """Whether all of these were known; now they are."""
        known = self.seen.issuperset(keys)
        self.seen.update(keys)
        return known

    def next_is(self, *words: str) -> bool:
        """Whether the next token is one of these words."""
        return self.place < len(self.tokens) and self.tokens[self.place] in words

    def take(self) -> str:
        """The next token, which is then behind."""
        self.place += 1
        return self.tokens[self.place - 1]

    def chain(self, level: int) -> Phrase | None:
        """Operands with operators of a level between them."""
        if level == len(_LEVELS):
            return self.operand()
        operands, operators = [self.chain(level + 1)], list[str]()
        while self.next_is(*_LEVELS[level]):
            operators.append(self.take())
            operands.append(self.chain(level + 1))
        parts = [part for part in operands if part is not None]
        if len(parts) < len(operands):
            return None
        if not operators:
            return parts[0]
        kept = [
            (place, place + 1)
            for place, (left, operator, right) in enumerate(zip(parts, operators, parts[1:], strict=False))
            if not (self.learn((left.kind, operator, right.kind)) and left.is_known and right.is_known)
        ]
        if not self.learn((operators[0], str(min(len(operators), 3)))):
            kept = [(place, place + 1) for place in range(len(operators))]
        places = sorted({place for pair in kept for place in pair})
        text = " ".join(f"{operators[place - 1]} {parts[place].written}" for place in places).split(" ", 1)[-1]
        return Phrase(text, f"n {operators[0]} n", operators[0], not kept)

    def operand(self) -> Phrase | None:
        """A sign or NOT with what follows, brackets, a number, a string, or a name with what belongs to it."""
        if self.place == len(self.tokens):
            return None
        token = self.take()
        if token in ("-", "NOT"):
            inner = self.operand()
            return None if inner is None else self._around(f"{token} " if token == "NOT" else token, inner, "")
        if token == "(":
            inner = self.chain(0)
            return None if inner is None or not self.next_is(")") else self._around("(", inner, self.take())
        if token[0] == "'" or token[0].isdigit():
            kind = "'" if token[0] == "'" else re.sub(r"\d+", "0", token)
            return Phrase(token, token, kind, self.learn((kind,)))
        return self._named(token) if re.match(r"[A-Za-z_]", token) else None

    def _around(self, left: str, inner: Phrase, right: str) -> Phrase:
        known = self.learn((left, inner.kind, right)) and inner.is_known
        return Phrase(f"{left}{inner.written}{right}", f"{left}n{right}", f"{left}{right}", known)

    def _named(self, name: str) -> Phrase | None:
        """A name with fields, indices and arguments; a word in capitals may be one of the grammar, and is itself."""
        text = short = name
        word = name if name.isupper() and len(name) > 1 else "n"
        kind, known = "n", self.learn((word,))
        while self.next_is(".", "[", "("):
            opening = self.take()
            if opening == ".":
                if self.place == len(self.tokens):
                    return None
                field = self.take()
                text, short, kind = f"{text}.{field}", f"{short}.{field}", f"{kind}."
                known = self.learn((word, kind)) and known
                continue
            parts = self._list(")" if opening == "(" else "]")
            if parts is None:
                return None
            closing = self.take()
            count = min(len(parts), 3)
            kind += opening + str(count)
            is_known = self.learn((word, kind, *sorted({part.kind for part in parts})))
            new = [part for part in parts if not part.is_known] if is_known and opening == "(" else parts
            text += opening + ", ".join(part.written for part in new or parts[:count]) + closing
            short += opening + ", ".join(part.short for part in parts[:count]) + closing
            known = known and is_known and all(part.is_known for part in parts)
        return Phrase(text, short, kind, known)

    def _list(self, closing: str) -> list[Phrase] | None:
        """Arguments or indices up to the closing bracket; of what kind the whole of one is."""
        parts: list[Phrase] = []
        while not self.next_is(closing):
            name = ""
            if self.tokens[self.place + 1 : self.place + 2] in ([":="], ["=>"]):
                name = f"{self.take()} {self.take()} "
            phrase = self.chain(0)
            if phrase is None or not self.next_is(closing, ","):
                return None
            known = self.learn((name[-3:], phrase.kind, closing)) and phrase.is_known
            parts.append(Phrase(name + phrase.written, f"{name}n", name[-3:], known))
            if self.next_is(",") and self.take() and self.next_is(closing):
                return None
        return parts
