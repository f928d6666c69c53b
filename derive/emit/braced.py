"""How C and JavaScript spell: expressions, and the parts of statements that the walk over a program puts together."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Sequence

import sympy as sp

from derive.emit.expression import ATOM, ExpressionPrinter, parts_of
from derive.ir.primitives import Select


class Braced(ExpressionPrinter):
    """Writes expressions in a language with braces: a choice evaluates only one side."""

    @abstractmethod
    def spelled(self, name: str) -> str:
        """The spelling of a variable of the function."""

    @abstractmethod
    def constant(self, name: sp.Symbol) -> str:
        """The words in front of a variable that gets its value once, with a space behind them."""

    @abstractmethod
    def declared(self, names: Sequence[sp.Symbol]) -> list[str]:
        """The declarations of variables that get their values later."""

    @abstractmethod
    def comment(self, note: str) -> list[str]:
        """A note as lines of comment; no line for an empty one."""

    @abstractmethod
    def commented(self, line: str, note: str) -> list[str]:
        """A statement with a note beside it, or above it if there is no room."""

    @abstractmethod
    def when(self, condition: str, statement: str) -> list[str]:
        """One statement that runs only if a condition holds."""

    def names(self, symbols: Iterable[sp.Symbol]) -> list[str]:
        """The spelling of several variables."""
        return [self.spelled(symbol.name) for symbol in symbols]

    def conjunction(self, conditions: Iterable[sp.Basic]) -> str:
        """Conditions that must all hold, as one."""
        parts = parts_of(conditions)
        if len(parts) == 1:
            return self.print(parts[0])
        printed = ((part, self.print(part)) for part in parts)
        return " && ".join(f"({one})" if isinstance(part, sp.Or) else one for part, one in printed)

    def whole_value(self, name: sp.Symbol, value: sp.Basic) -> str:
        """A value that stands alone behind `=`, where a choice needs no brackets."""
        text = self.value(name, value)
        return text[1:-1] if isinstance(value, Select) and text.startswith("(") else text

    def choice(self, condition: str, first: str, second: str) -> str:
        return f"({condition} ? {first} : {second})"

    def logic(self, word: str) -> str:
        return {"and": "&&", "or": "||", "not": "!"}.get(word, word)

    def _spell(self, node: sp.Basic) -> tuple[str, int]:
        if isinstance(node, sp.Not):
            return f"!{self._text(node.args[0], ATOM)}", ATOM
        return super()._spell(node)
