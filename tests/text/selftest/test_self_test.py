"""The self-test for the controller: everything passes on what was generated, and every planted fault is found."""

from __future__ import annotations

import re
from dataclasses import astuple
from functools import cache
from typing import Any

import pytest

from bench.counting import counting_library
from derive.description.mechanism import Mechanism
from tests.harness.library import Library, compile_st
from tests.mechanisms import catalogue
from tests.text.breakage import MECHANISM, WRONG, texts
from tests.text.counting import counted
from tests.text.selftest.planted import planted
from tests.text.units import FOLDER, file_of, shared_texts, text_of

ALL = tuple(m for _, m in catalogue())
PROGRAM = "PRG_SoftkinSelfTest"
SELF_TESTS = {path.name: path.read_text(encoding="utf-8") for path in sorted((FOLDER / "selftest").glob("*.st"))}
UNBOUNDED = 10**9
"""More operations than any case needs."""
WORST = 1e-6
"""What rounding the expected numbers to 6 decimals leaves is half of it."""


def self_test(mechanism: Mechanism) -> dict[str, str]:
    """The text of a mechanism's self-test."""
    name = f"{mechanism.block_name}_SelfTest.st"
    return {name: SELF_TESTS[name]}


@cache
def counts(name: str) -> int:
    """How many cases a self-test has, by its own table."""
    found = re.search(r"CASES : ARRAY\[0\.\.(\d+),", SELF_TESTS[name])
    assert found is not None
    return int(found.group(1)) + 1


def run(library: Library, name: str) -> Any:
    """An instance that has run to its end: a case in every cycle, no more and no less."""
    test = library.new(name)
    test.udiOperations = UNBOUNDED
    cycles = 0
    while not test.xDone:
        test()
        cycles += 1
        assert test.iPassed + test.iFailed == cycles, "a case in every cycle"
    assert cycles == counts(f"{name}.st")
    return test


def test_there_is_one_for_every_block() -> None:
    """There is a self-test for every block, and one program that runs them all."""
    assert set(SELF_TESTS) == {f"{m.block_name}_SelfTest.st" for m in ALL} | {f"{PROGRAM}.st"}


@pytest.mark.parametrize("order", ["rows", "columns"])
def test_all_blocks_pass_one_after_the_other(order: str) -> None:
    """The program as a controller runs it: never more than a single case in a cycle."""
    everything = {str(p): p.read_text(encoding="utf-8") for p in sorted(FOLDER.rglob("*.st"))}
    program = compile_st(everything, order).new(PROGRAM)
    program.udiOperations = UNBOUNDED
    total = sum(counts(name) for name in SELF_TESTS if name != f"{PROGRAM}.st")
    for _ in range(total):
        assert not program.xDone
        program()
    assert program.xDone
    assert (program.iPassed, program.iFailed, program.iLeftOut) == (total, 0, 0)
    assert (program.sFirstBlock, program.iFirstCase, program.sFirstCall) == ("", -1, "")
    assert 0.0 < program.dWorst < WORST
    program()
    assert program.iPassed == total, "it stays as it is"
    program(xRestart=True)
    assert (program.xDone, program.iPassed) == (False, 0)


@pytest.mark.parametrize("mechanism", ALL, ids=lambda m: m.name)
def test_no_cycle_does_more_than_it_may(mechanism: Mechanism) -> None:
    """Counted while it runs: with the bound as it comes, with a small one, and with none every case within its own."""
    name = f"{mechanism.block_name}_SelfTest"
    texts = {**shared_texts(), **self_test(mechanism), file_of(mechanism): text_of(mechanism)}
    library = counting_library(texts)
    least = min(stated_operations(name))
    for allowed in (UNBOUNDED, None, 1000, least):
        test = library.new(name)
        if allowed is not None:
            test.udiOperations = allowed
        for stated in stated_operations(name):
            spent = sum(astuple(counted(test)))
            assert spent <= min(stated, test.udiOperations)
        assert (test.xDone, test.iFailed) == (True, 0)
        assert test.iPassed + test.iLeftOut == counts(f"{name}.st")
        assert (test.iLeftOut == 0) == (allowed == UNBOUNDED or max(stated_operations(name)) <= test.udiOperations)


def stated_operations(name: str) -> list[int]:
    """What the table of a self-test says that each case needs at most."""
    found = re.search(r"OPERATIONS : [^[]*\[[^[]*\[([\d,\s]*)\]", SELF_TESTS[f"{name}.st"])
    assert found is not None
    return [int(number) for number in found.group(1).split(",")]


CALLED_BY = {
    "FindPose": "AxesToCartesian",
    "SolveBranch": "CartesianToAxes",
    "ReadInputs": "CartesianToAxes",
    "FindMargins": "IsSingularity",
}


@pytest.mark.parametrize("mechanism", ALL, ids=lambda m: m.name)
def test_every_planted_fault_is_found(mechanism: Mechanism) -> None:
    """And a test that is restarted with a block that is right again passes again."""
    spoiled = planted(mechanism)
    library = compile_st({**shared_texts(), **self_test(mechanism), file_of(mechanism): spoiled.text})
    name = f"{mechanism.block_name}_SelfTest"
    test = run(library, name)
    assert (test.iFailed, test.iLeftOut, test.iFirstCase, test.sFirstCall) == (0, 0, -1, "")
    assert test.iPassed == counts(f"{name}.st")
    assert test.dWorst < WORST
    missed = []
    for number, fault in spoiled.faults.items():
        test.kinematics.iFault = number
        test(xRestart=True)
        while not test.xDone:
            test(xRestart=False)
        where = CALLED_BY[fault.split(":")[0]]
        if not test.iFailed or test.sFirstCall != where:
            missed.append(fault)
    assert missed == []
    test.kinematics.iFault = 0
    test(xRestart=True)
    while not test.xDone:
        test(xRestart=False)
    assert (test.iFailed, test.iFirstCase) == (0, -1)


FOUND = (
    "CartesianToAxes: a sign",
    "AxesToCartesian: a sign",
    "CartesianToAxes: an offset",
    "CartesianToAxes: two axes exchanged",
    "AxesToCartesian: two bytes exchanged",
    "CartesianToAxes: an error",
    "CartesianToAxes: a turn",
    "CartesianToAxes: a constant of the machine",
)


@pytest.mark.parametrize("fault", FOUND)
def test_a_mistake_in_a_formula_is_found(fault: str) -> None:
    """The self-test fails for a block with a wrong formula, and names the first case that failed."""
    library = compile_st({**texts(WRONG[fault]), **self_test(MECHANISM)})
    test = run(library, f"{MECHANISM.block_name}_SelfTest")
    assert test.iFailed > 0
    assert test.iFirstCase >= 0


def test_a_refusal_that_stays_away_is_found() -> None:
    """A tolerance of 2 instead of 1E-4: what is no rotation is accepted."""
    shared, file = dict(shared_texts()), "Softkin_MakeRotation.st"
    loose = shared[file].replace("<= 0.0001", "<= 2.0")
    assert loose != shared[file]
    library = compile_st({**shared, file: loose, **self_test(MECHANISM), file_of(MECHANISM): text_of(MECHANISM)})
    assert run(library, f"{MECHANISM.block_name}_SelfTest").iFailed > 0
