"""A program as a function of Python's own numbers: the reference interpreter for few rows, of which each operation on
arrays takes as long as on hundreds.

It rounds as arrays do: all but sums, products, roots and comparisons is asked of the same functions. It shares nothing
with the Python that is generated, which is measured against it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from math import sqrt
from typing import Any

import sympy as sp

from derive.ir.primitives import solved
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Solve, Statement
from derive.ir.python_text import NUMBERS, Expressions, declared
from derive.kept import kept_by_identity


class Refused(Exception):
    """The program refuses: `args` has its status."""


@dataclass
class Repeats:
    """How often the bodies of loops have run, for all rows together."""

    passes: Counter[str] = field(default_factory=Counter)
    """Passes of iterations, by their notes."""
    runs: Counter[str] = field(default_factory=Counter)
    """Runs of called programs, by their names."""
    steps: int = 0
    """The statements that have run, one row at a time."""


Function = Callable[..., tuple[Any, ...]]


@kept_by_identity(500)
def function_of(program: Program) -> Function:
    """Repeats, and the values of `program.inputs` → those of its outputs. Raises `Refused`."""
    writer = _Writer(NUMBERS, {"Refused": Refused, "sqrt": sqrt, "solved": solved})
    lines = [f"def function(repeats, {', '.join(map(writer.name, program.inputs))}):", *writer.block(program.body)]
    lines += writer.returned(program.outputs)
    return writer.executed(lines, f"<{program.name}>")


class _Writer(Expressions):
    """The text of a program, and what it reads besides its inputs."""

    def block(self, statements: Sequence[Statement], indent: str = "    ") -> Iterator[str]:
        yield f"{indent}repeats.steps += {len(statements)}"
        for statement in statements:
            for line in self._lines(statement):
                yield from self.before(indent + line[: len(line) - len(line.lstrip())])
                yield indent + line

    def returned(self, outputs: Sequence[Output]) -> Iterator[str]:
        values = "".join(self.text(o.value) + ", " for o in outputs)
        yield from self.before("    ")
        yield f"    return ({values})"

    def _lines(self, statement: Statement) -> Iterator[str]:
        if isinstance(statement, Let):
            yield self._bound(statement.name, statement.value)
        elif isinstance(statement, Require):
            yield f"if not {self.text(statement.condition)}: raise Refused({self.given(statement.otherwise)})"
        elif isinstance(statement, Solve):
            yield from self._solved(statement)
        elif isinstance(statement, Call):
            yield from self._called(statement)
        else:
            yield from self._repeated(statement)

    def _bound(self, name: sp.Symbol, value: sp.Basic) -> str:
        return f"{self.name(name)} = {declared(name).__name__}({self.text(value)})"

    def _solved(self, system: Solve) -> Iterator[str]:
        size, columns = system.size, system.columns
        rows = [
            [*system.matrix[size * k : size * (k + 1)], *system.right[columns * k : columns * (k + 1)]]
            for k in range(size)
        ]
        table = ", ".join(f"[{', '.join(f'float({self.text(e)})' for e in row)}]" for row in rows)
        yield f"determinant, rows = solved([{table}], {size})"
        for k, name in enumerate(system.names):
            yield f"{self.name(name)} = rows[{k // columns}][{k % columns}]"
        if system.determinant is not None:
            yield f"{self.name(system.determinant)} = determinant"

    def _called(self, call: Call) -> Iterator[str]:
        values, own = dict(call.given), self.given(function_of(call.program))
        arguments = "".join(f", {self.text(values.get(s, s))}" for s in call.program.inputs)
        places = [o.name for o in call.program.outputs]
        yield f"if {self.text(call.wanted)}:"
        yield f"    repeats.runs[{call.program.name!r}] += 1"
        if call.refusal is None:
            yield f"    found = {own}(repeats{arguments})"
        else:
            yield f"    try: found = {own}(repeats{arguments})"
            yield f"    except Refused: raise Refused({self.given(call.refusal[0])}) from None"
        for name in call.names:
            yield f"    {self.name(name)} = found[{places.index(name.name)}]"
        if call.is_conditional and call.names:
            yield f"else: {' = '.join(map(self.name, call.names))} = 0"

    def _repeated(self, loop: Iterate) -> Iterator[str]:
        for name, value in zip(loop.state, loop.start, strict=True):
            yield self._bound(name, value)
        yield f"for _ in range({loop.limit}):"
        yield f"    repeats.passes[{loop.note!r}] += 1"
        yield from self.block(loop.step)
        yield f"    if {self.text(loop.done)}: break"
        states = list(zip(loop.state, loop.following, strict=True))
        for k, (name, value) in enumerate(states):
            yield f"    next_{k} = {self._bound(name, value).partition(' = ')[2]}"
        yield from (f"    {self.name(name)} = next_{k}" for k, (name, _) in enumerate(states))
        if loop.otherwise is not None:
            yield f"else: raise Refused({self.given(loop.otherwise)})"
