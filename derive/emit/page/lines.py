"""Programs as lines of a page: a value with its name, a choice, a refusal, linear equations, a loop, a call."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp
from markupsafe import Markup

from derive.emit.page.mathml import WIDTH, MathML, element
from derive.emit.page.names import Spelling
from derive.emit.st.shared import method_name
from derive.ir.primitives import Select
from derive.ir.program import Call, FindRoot, Iterate, Let, Require, Solve, Statement
from derive.ir.tree import If, Item

_EQUALS = 10
"""The room of the sign between a name and its value, and of the number of a step behind it."""
_HEAD, _TAIL = '<math displaystyle="true">', "</math>"


@dataclass(frozen=True)
class Case:
    """One of the values that a name may have."""

    value: tuple[str, ...]
    condition: tuple[str, ...]
    """The condition under which the name has this value; empty: in all other cases."""


@dataclass(frozen=True)
class Line:
    """A line of a program."""

    kind: str
    """"value", "cases", "refuse", "where", "otherwise", "equations", "matrix", "loop" or "call"."""
    name: str = ""
    """The element of the name that is bound."""
    math: tuple[str, ...] = ()
    """The value behind the name: elements, one for each line."""
    cases: tuple[Case, ...] = ()
    note: str = ""
    depth: int = 0
    neutral: str = ""
    """The neutral name that is bound."""
    step: int | None = None
    """The step of the derivation that binds the same name."""


class Lines:
    """Writes programs as lines."""

    def __init__(self, spelling: Spelling, steps: Mapping[str, int] | None = None) -> None:
        """steps: the number of the step of the derivation that binds a name."""
        self._spelling, self._steps = spelling, steps or {}
        self.math = MathML(spelling)

    def of(self, items: Iterable[Item], depth: int = 0) -> Iterator[Line]:
        """The lines of statements in their order."""
        for item in items:
            for line in self._item(item):
                yield replace(line, depth=line.depth + depth, note=self._spelling.text(line.note))

    def _item(self, item: Item) -> Iterator[Line]:
        if isinstance(item, If):
            holds, fails = item.sides
            yield Line("where", math=self.math.lines(item.condition), note="; ".join(item.comments))
            yield from self.of(holds, 1)
            yield Line("otherwise")
            yield from self.of(fails, 1)
        elif isinstance(item, Let):
            yield self._let(item)
        elif isinstance(item, Require):
            words = item.comment.replace("inputs must be numbers", "inputs that are no numbers")
            yield Line("refuse", math=self.math.lines(item.condition), note=words)
        elif isinstance(item, Solve):
            yield from self._linear(item)
        elif isinstance(item, Iterate):
            yield from self._loop(item)
        elif isinstance(item, Call):
            line = self._call(item)
            yield replace(line, note=f"only where a pose would be refused: {line.note}") if item.is_rare else line
        else:
            yield from self._search(item)

    def _call(self, call: Call) -> Line:
        pairs = [(name, value) for name, value in call.given if name != value]
        given = [line for name, value in pairs for line in self.math.equation(name, value)]
        names = ", ".join(self._spelling(n.name) for n in call.names)
        what = call.note or "a program that several methods share"
        note = f"{what}: {method_name(call.program)}, which gives {names}{', with' if given else ''}"
        return Line("call", math=tuple(given), note=note)

    def _let(self, let: Let) -> Line:
        own = Line("value", self.name(let.name), note=let.comment, neutral=let.name.name)
        own = replace(own, step=self._steps.get(let.name.name))
        if not isinstance(let.value, Select):
            return replace(own, math=self.math.lines(let.value, WIDTH - len(self._spelling(let.name.name)) - _EQUALS))
        return replace(own, kind="cases", cases=tuple(self._cases(let.value)))

    def name(self, name: sp.Symbol) -> str:
        """The element of a name."""
        return element(self.math.row(name))

    def _cases(self, value: sp.Basic) -> Iterator[Case]:
        while isinstance(value, Select):
            condition, first, value = value.args
            yield Case(self.math.lines(first), self.math.lines(condition))
        yield Case(self.math.lines(value), ())

    def _linear(self, item: Solve) -> Iterator[Line]:
        note = item.note or "linear equations, by elimination with pivoting"
        if item.right:
            rows = [self._sides(item, k) for k in range(item.size)]
            yield Line("equations", math=tuple(line for row in rows for line in row), note=note)
        if (made := item.determinant) is not None:
            yield Line("matrix", self.name(made), (self._matrix(item),), note=note, neutral=made.name)

    def _matrix(self, item: Solve) -> Markup:
        """The determinant of the matrix."""
        cells = [element(self.math.row(e)) for e in item.matrix]
        rows = [cells[k : k + item.size] for k in range(0, len(cells), item.size)]
        return matrix(rows, "|", "|")

    def _sides(self, item: Solve, row: int) -> Iterator[str]:
        """One row of the equations, for every column of unknowns."""
        for column in range(item.columns):
            unknowns = item.names[column :: item.columns]
            matrix = item.matrix[row * item.size : (row + 1) * item.size]
            left = sp.Add(*(m * u for m, u in zip(matrix, unknowns, strict=True)))
            yield from self.math.equation(left, item.right[row * item.columns + column])

    def _loop(self, item: Iterate) -> Iterator[Line]:
        state = [line for s, v in zip(item.state, item.start, strict=True) for line in self.math.equation(s, v)]
        yield Line("loop", math=tuple(state), note=f"{item.note}: begin with")
        yield Line("loop", note=f"repeat, at most {item.limit} times")
        for statement in item.step:
            if isinstance(statement, Call) and statement.is_conditional:
                yield Line("where", math=self.math.lines(statement.wanted), depth=1)
                yield replace(self._call(statement), depth=2)
            else:
                yield from self.of((statement,), 1)
        yield Line("where", math=self.math.lines(item.done), note="the end is reached", depth=1)
        following = zip(item.state, item.following, strict=True)
        yield Line("otherwise", math=tuple(line for s, v in following for line in self.math.equation(s, v)), depth=1)

    def _search(self, item: FindRoot) -> Iterator[Line]:
        arguments = ", ".join(self._spelling(s.name) for s in item.arguments)
        what = item.note or "search for a root"
        of = "candidates" if item.is_listed else "trials"
        note = f"{what}: the root nearest to the value below, of {of} that read {arguments}"
        yield Line("call", math=(self.math.inline(item.start),), note=note)


def steps_by_name(spans: Sequence[tuple[int, Sequence[Statement]]]) -> dict[str, int]:
    """The number of the step that binds a name."""
    return {s.name.name: number for number, statements in spans for s in statements if isinstance(s, Let)}


def matrix(rows: Sequence[Sequence[str]], opening: str = "(", closing: str = ")") -> Markup:
    """A matrix of elements."""
    inner = [[e.removeprefix(_HEAD).removesuffix(_TAIL) for e in row] for row in rows]
    cells = ("".join(f"<mtd>{e}</mtd>" for e in row) for row in inner)
    table = "".join(f"<mtr>{row}</mtr>" for row in cells)
    return Markup(f"<math><mrow><mo>{opening}</mo><mtable>{table}</mtable><mo>{closing}</mo></mrow></math>")
