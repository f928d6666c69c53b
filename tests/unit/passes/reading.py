"""Golden files of passes: what stands in one, read back from the text form of programs."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import sympy as sp

from derive.ir import primitives
from derive.ir.constants import DEGREE
from derive.ir.program import Let, Output, Program, Require, Status
from derive.ir.reason import Kind, Reason, Subject, Unit, Why
from derive.ir.symbols import Sign, count, flag, real
from derive.ir.tree import If, Item, Tree, bindings_in, statements_in
from derive.lowering.passes import Given

BECOMES = "\nbecomes\n"
"""The line between a program and what a pass makes of it."""
_FUNCTIONS = {name: value for name, value in vars(primitives).items() if isinstance(value, sp.FunctionClass)}
_KNOWN = {**_FUNCTIONS, "DEGREE": DEGREE, "Abs": sp.Abs, "cos": sp.cos, "sin": sp.sin, "Ne": sp.Ne}
_REQUIRE = re.compile(r"require (.+) else (\w+)(?:: (\w+) (.*?) ([A-Z_\d]+)(?:, missing (.*?)(?: \[(\w+)])?)?)?$")


@dataclass
class Case:
    """A golden file: its first lines say what it shows, and what a pass is given besides the program."""

    path: Path
    types: dict[str, sp.Symbol] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.before, _, self.after = self.path.read_text(encoding="utf-8").partition(BECOMES)
        self._lines = [line for line in self.before.splitlines() if not line.startswith("#")]
        self.given = self._given()
        self.tree = self._tree()

    def _given(self) -> Given:
        """What the pass is given: `constants c, d`, `known e = c + d`, `inputs turn = 0`, `signs sigma_a up down`."""
        lines = [line.split(" ", 1) for line in self._lines if not line.startswith(" ")]
        keys = ("constants", "known", "inputs", "signs")
        words = {key: [text for word, text in lines if word == key] for key in keys}
        signs = [text.split() for text in words["signs"]]
        self.types |= {name: count(name) for name, *_ in signs}
        self.known = tuple(self._let(text) for text in words["known"])
        return Given(
            constants=frozenset(name for text in words["constants"] for name in text.split(", ")),
            inputs={let.name: let.value for let in map(self._let, words["inputs"])},
            signs=tuple(Sign(count(name), (first, second)) for name, first, second in signs),
        )

    def _tree(self) -> Tree:
        """The program, with choices where the file has them."""
        body = [line[4:] for line in self._lines if line.startswith(" ")]
        returned = [line.removeprefix("return ") for line in body if line.startswith("return ")]
        items = tuple(self._items([line for line in body if not line.startswith("return ")]))
        outputs = [o for text in returned for o in ([text] if " = " in text else text.split(", "))]
        program = Program("p", (), tuple(statements_in(items)), tuple(map(self._output, outputs)))
        return Tree(replace(program, inputs=tuple(sorted(program.reads(), key=str))), items)

    def _items(self, lines: list[str]) -> Iterator[Item]:
        while lines:
            line = lines.pop(0)
            if not line.startswith("if "):
                yield self._require(line) if line.startswith("require ") else self._let(line)
                continue
            holds = tuple(self._items(_side(lines)))
            assert lines.pop(0) == "else:"
            fails = tuple(self._items(_side(lines)))
            both = set(bindings_in(fails))
            names = tuple(name for name in dict.fromkeys(bindings_in(holds)) if name in both)
            yield If(self._value(line[3:-1]), holds, fails, names)

    def _let(self, line: str) -> Let:
        line, _, note = line.partition("  # ")
        name, value = line.split(" = ", 1)
        name, _, kind = name.partition(": ")
        self.types[name] = {"": real, "int": count, "bool": flag}[kind](name)
        return Let(self.types[name], self._value(value), note)

    def _require(self, line: str) -> Require:
        line, _, note = line.partition("  # ")
        found = _REQUIRE.match(line)
        assert found is not None, line
        condition, status, kind, subject, why, missing, unit = found.groups()
        amount = None if missing is None else self._value(missing)
        reason = Reason(Subject(Kind[kind], subject), Why[why], amount, Unit(unit or "")) if kind else None
        return Require(self._value(condition), Status[status], note, reason)

    def _output(self, text: str) -> Output:
        name, _, value = text.partition(" = ")
        return Output(name, self._value(value or name))

    def _value(self, text: str) -> sp.Basic:
        names = set(re.findall(r"\b[a-z]\w*\b(?!\()", text))
        return sp.sympify(text, _KNOWN | {name: self.types.get(name, real(name)) for name in names})


def _side(lines: list[str]) -> list[str]:
    """The lines of a side, which are taken away."""
    count_ = next((k for k, line in enumerate(lines) if not line.startswith("    ")), len(lines))
    taken, lines[:] = lines[:count_], lines[count_:]
    return [line[4:] for line in taken]
