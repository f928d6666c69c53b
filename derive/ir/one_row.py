"""A program as a function of Python's own numbers: the reference interpreter for few rows. One row of a program that
iterates took 7 times as long on arrays (a hexapod), and 36 times (an arm that is searched).

It rounds as arrays do: all but sums, products, roots and comparisons is asked of the same functions. It shares nothing
with the Python that is generated, which is measured against it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import count
from math import inf, nan, sqrt
from typing import Any

import numpy as np
import sympy as sp

from derive.ir.constants import DEGREE
from derive.ir.primitives import VALUES, Root, Select, ToReal, solved
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Solve, Statement
from derive.ir.symbols import Flag, is_count, is_decided
from derive.kept import kept_by_identity

_BETWEEN = {
    sp.Add: " + ", sp.Mul: " * ", sp.And: " and ", sp.Or: " or ", sp.Le: " <= ", sp.Lt: " < ", sp.Ge: " >= ",
    sp.Gt: " > ", sp.Eq: " == ", sp.Ne: " != ",
}  # fmt: skip
_TEXTS = {
    sp.Not: "(not {})", Select: "({1} if {0} else {2})", ToReal: "float({})", sp.Abs: "abs({})",
    Root: "sqrt(max({}, 0.0))",
}  # fmt: skip

_DEEP = 50
"""A value that is nested so deeply has a line of its own."""


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
    writer = _Writer(program)
    lines = [f"def function(repeats, {', '.join(map(writer.name, program.inputs))}):", *writer.block(program.body)]
    lines += writer.returned(program.outputs)
    exec(compile("\n".join(lines), f"<{program.name}>", "exec"), writer.known)  # noqa: S102 (our own text, of no file)
    return writer.known["function"]  # type: ignore[no-any-return]


class _Writer:
    """The text of a program, and what it reads besides its inputs."""

    def __init__(self, program: Program) -> None:
        self.known: dict[str, Any] = {
            "Refused": Refused, "sqrt": sqrt, "inf": inf, "nan": nan, "solved": solved
        }  # fmt: skip
        self._names: dict[str, str] = {}
        self._free = count()
        self._before: list[str] = []
        """The lines of what is nested too deeply, to stand before the line that reads it."""

    def name(self, symbol: sp.Symbol) -> str:
        return self._names.setdefault(symbol.name, f"v{len(self._names)}")

    def given(self, what: object) -> str:
        """A name for an object that the text reads."""
        word = f"given_{next(self._free)}"
        self.known[word] = what
        return word

    def block(self, statements: Sequence[Statement], indent: str = "    ") -> Iterator[str]:
        yield f"{indent}repeats.steps += {len(statements)}"
        for statement in statements:
            for line in self._lines(statement):
                inner = indent + line[: len(line) - len(line.lstrip())]
                yield from (inner + one for one in self._before)
                self._before.clear()
                yield indent + line

    def returned(self, outputs: Sequence[Output]) -> Iterator[str]:
        values = "".join(self.text(o.value) + ", " for o in outputs)
        yield from (f"    {one}" for one in self._before)
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
        return f"{self.name(name)} = {_DECLARED[isinstance(name, Flag), is_count(name)]}({self.text(value)})"

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

    def text(self, value: sp.Basic, depth: int = 0) -> str:
        """An expression in Python, whose parser reads at most 200 brackets in each other."""
        if depth == _DEEP:
            word = f"deep_{next(self._free)}"
            self._before.append(f"{word} = {self.text(value)}")
            return word
        if isinstance(value, sp.Symbol) and value != DEGREE:
            return self.name(value)
        if is_decided(value):
            return str(value == sp.true)
        if value == DEGREE or isinstance(value, sp.Number | sp.NumberSymbol):
            return f"({np.pi / 180.0 if value == DEGREE else float(value)!r})"
        kind, parts = type(value), [self.text(a, depth + 1) for a in value.args]
        if kind in _BETWEEN:
            return f"({_BETWEEN[kind].join(parts)})"
        if kind in _TEXTS:
            return _TEXTS[kind].format(*parts)
        function = f"of_{kind.__name__.lower()}"
        self.known[function] = VALUES[kind]
        return f"float({function}({', '.join(parts)}))"


_DECLARED = {(False, False): "float", (True, False): "bool", (False, True): "int"}
"""By whether a name is a flag, and whether it is a count: a count is made of integers, so never of NaN."""
