"""Golden files: for every pass of the list, programs in front of it and behind it.

`python -m tests.unit.passes.test_golden` writes what the passes make now; read the difference before it is committed.
"""

from dataclasses import replace
from itertools import chain
from pathlib import Path

import pytest

from derive.ir.passes import normalise
from derive.ir.program import Program
from derive.ir.text import text_of_tree
from derive.ir.tree import Tree
from derive.lowering import passes
from derive.lowering.draft import Reader
from derive.lowering.hoisting import Constant, Gathering
from derive.lowering.passes import Given, OnDrafts, Pass, Shared, lowered
from derive.lowering.writing import written
from tests.unit.answers import same
from tests.unit.passes.reading import BECOMES, Case

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
