"""Golden files: for every pass of the list, programs in front of it and behind it.

`python -m tests.unit.passes.test_golden` writes what the passes make now; read the difference before it is committed.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import chain
from pathlib import Path

import pytest
import sympy as sp

from derive.ir import primitives
from derive.ir.constants import DEGREE
from derive.ir.passes import normalise
from derive.ir.program import Let, Output, Program, Require, Status
from derive.ir.reason import Kind, Reason, Subject, Unit, Why
from derive.ir.symbols import Sign, count, flag, real
from derive.ir.text import text_of_tree
from derive.ir.tree import If, Item, Tree, bindings_in, statements_in
from derive.lowering import passes
from derive.lowering.draft import Reader
from derive.lowering.hoisting import Constant, Gathering
from derive.lowering.passes import Given, OnDrafts, Pass, Shared, lowered
from derive.lowering.writing import written
from tests.unit.answers import same

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
    count_ = next((k for k, line in enumerate(lines) if not line.startswith("    ")), len(lines))
    taken, lines[:] = lines[:count_], lines[count_:]
    return [line[4:] for line in taken]


CASES = sorted(Path(__file__).parent.glob("*/*.txt"))
ON_PROGRAMS: list[Pass[Program, Given]] = [
    Pass("normalise", lambda program, _: normalise(program.name, program.body, program.outputs)),
    *passes.DERIVED, *passes.UNCONVERTED, *passes.ANY_TURN, *passes.TRUSTED, *passes.WITHOUT_SQUARES, passes.REGULAR,
]  # fmt: skip
ON_TREES = [*passes.SIDES, *passes.ARRAYS, *passes.WRITTEN_SHORT]
ON_DRAFTS = list(chain(*passes.EVERY.stages, *passes.LANES.stages))
ANSWERS_CHANGE = {
    "hoisted", "mirrored", "normalise", "regular", "specialised", "symmetry", "unrolled", "with_rotation_identities",
    "without_chosen_turns",
}  # fmt: skip
"""Passes with other inputs or outputs, for statements in any order, or with other answers at some poses."""
TOGETHER = {
    "hoisted": OnDrafts((passes.SHORTER[:1],)), "lowered": passes.EVERY, "straight_line": passes.STRAIGHT_LINE,
}  # fmt: skip
"""Passes one after the other, and the constants that they hoist."""
NAMES = {one.name for one in (*ON_PROGRAMS, *ON_TREES, *ON_DRAFTS)} | TOGETHER.keys()
KEEPING = NAMES - ANSWERS_CHANGE - {one.name for one in ON_TREES}


def made(case: Case) -> Program | Tree | None:
    """What a pass makes of the program of a case."""
    name, given, tree = case.path.parent.name, case.given, case.tree
    program = tree.program
    if name in TOGETHER:
        (program,), parts = lowered([program], given.constants, TOGETHER[name], known=case.known)
        return replace(program, body=(*parts, *program.body))
    for on_programs in (one for one in ON_PROGRAMS if one.name == name):
        return on_programs.change(program, given)
    for on_trees in (one for one in ON_TREES if one.name == name):
        return on_trees.change(tree, given)
    reader, constant = Reader(), Constant(given.constants)
    draft = reader.draft(program)
    branches = {program.name: given.signs} if given.signs else {}
    shared = Shared(reader.graph, constant, Gathering(reader.graph, constant), branches)
    one = next(one for one in ON_DRAFTS if one.name == name)
    return written(one.change(draft, shared), {}, given.constants)


def text_behind(case: Case) -> str:
    """The text of what a pass makes, without the line of its inputs."""
    found, before = made(case), text_of_tree(case.tree)
    if found is None:
        return "    nothing\n"
    text = text_of_tree(Tree.of(found) if isinstance(found, Program) else found)
    return "    the same\n" if text == before else text.split("\n", 1)[1]


@pytest.mark.parametrize("path", CASES, ids=str)
def test_a_pass_makes_what_stands_there(path: Path) -> None:
    case = Case(path)
    assert text_behind(case) == case.after, "if that is meant: python -m tests.unit.passes.test_golden"


@pytest.mark.parametrize("path", [p for p in CASES if p.parent.name in KEEPING], ids=str)
def test_the_answers_stay_the_same(path: Path) -> None:
    """Run with random numbers, in front of the pass and behind it."""
    case = Case(path)
    before, after = case.tree.program, made(case)
    assert isinstance(after, Program)
    same(before, replace(after, inputs=tuple(s for s in before.inputs if s in after.reads())))


def test_every_pass_has_golden_files_and_every_folder_a_pass() -> None:
    """A new pass of the list brings a folder; a pass that goes takes its folder along."""
    assert {path.parent.name for path in CASES} == NAMES


if __name__ == "__main__":
    for written_path in CASES:
        one_case = Case(written_path)
        written_path.write_text(one_case.before + BECOMES + text_behind(one_case), encoding="utf-8")
