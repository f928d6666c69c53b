"""The walk over the statements of a program, and what C and JavaScript make of each kind of statement."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import sympy as sp

from derive.emit.braced import Braced, block, indented
from derive.emit.refusals import Refusals
from derive.ir.program import Call, Iterate, Let, Require, Solve
from derive.ir.tree import If, Item, grouped


@dataclass
class Body(ABC):
    """The statements of one function in a language with braces."""

    endless: ClassVar[str]
    """The head of a loop without a bound, from its counter `pass` to the place of the bound."""
    numbering: ClassVar[str]
    """What stands between a word and a number in the name of a variable of the function itself."""
    refusals: Refusals
    declared: set[sp.Symbol] = field(default_factory=set, kw_only=True)
    """The names that are declared before the choice that gives them, or before the loop."""
    numbered: dict[str, int] = field(default_factory=dict, kw_only=True)
    """For each word, the number of variables with a name made of it."""

    @property
    def printer(self) -> Braced:
        """How the language spells."""
        return self.refusals.printer

    @abstractmethod
    def solve(self, system: Solve) -> list[str]:
        """Linear equations."""

    @abstractmethod
    def call(self, call: Call) -> list[str]:
        """A call of a shared program."""

    @abstractmethod
    def begin(self, state: Sequence[sp.Symbol], values: Sequence[str]) -> list[str]:
        """The variables of the state of a loop, with their first values."""

    def lines(self, items: Sequence[Item]) -> list[str]:
        """Statements, choices with their sides."""
        return [line for item, same in grouped(items) for line in self._item(item, same)]

    def _item(self, item: Item, same: Sequence[Require]) -> list[str]:
        match item:
            case Require():
                return self.refusals.lines(same)
            case If():
                return self._choice(item)
            case Let():
                return self._let(item)
            case Solve():
                return self.solve(item)
            case Iterate():
                return self._loop(item)
            case Call():
                return self.call(item)

    def _let(self, let: Let) -> list[str]:
        """A variable, or what is assigned to one that is declared."""
        word = "" if let.name in self.declared else self.printer.constant(let.name)
        value = self.printer.whole_value(let.name, let.value)
        return self.printer.commented(f"{word}{self.printer.spelled(let.name.name)} = {value};", let.comment)

    def _choice(self, arms: If) -> list[str]:
        """A choice, behind the declarations of the names that both sides give."""
        head = self._declarations(arms.names)
        holds, fails = self.lines(arms.holds), self.lines(arms.fails)
        first = block(f"if ({self.printer.conjunction([arms.condition])})", holds)
        return [*head, *first[:-1], "} else {", *indented(fails), "}"]

    def _loop(self, loop: Iterate) -> list[str]:
        """The step, then the end of the loop or the next state; the names of the step are read behind it, too."""
        refusal = "" if loop.otherwise is None else self.refusals.of_loop(loop.otherwise, loop)
        last = f"pass {self.printer.comparison('==')} {loop.limit}"
        head = [
            *self.printer.comment(loop.note),
            *self.begin(loop.state, self._values(loop, loop.start)),
            *self._declarations([name for s in loop.step for name in s.bound()]),
        ]
        following = zip(self.printer.names(loop.state), self._values(loop, loop.following), strict=True)
        inner = [
            *(block(f"if ({last})", [refusal]) if refusal else []),
            *self.lines(loop.step),
            *self.printer.when(self.printer.conjunction([loop.done]), "break;"),
            *(f"{name} = {value};" for name, value in following),
        ]
        bounded = self.endless if refusal else f"{self.endless.rstrip()} pass < {loop.limit}"
        return [*head, *block(f"for ({bounded}; pass += 1)", inner)]

    def given(self, call: Call) -> list[str]:
        """The arguments of a call, in the order of its program."""
        values = dict(call.given)
        return [self.printer.value(name, values[name]) for name in call.program.inputs if name in values]

    def another(self, word: str) -> str:
        """The name of another variable of the function itself."""
        self.numbered[word] = count = self.numbered.get(word, 0) + 1
        return word if count == 1 else f"{word}{self.numbering}{count}"

    def _declarations(self, names: Sequence[sp.Symbol]) -> list[str]:
        """The declarations of names that are not declared yet."""
        own = [name for name in names if name not in self.declared]
        self.declared.update(own)
        return self.printer.declared(own)

    def _values(self, loop: Iterate, values: Sequence[sp.Basic]) -> list[str]:
        return [self.printer.value(name, value) for name, value in zip(loop.state, values, strict=True)]
