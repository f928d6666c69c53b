"""The self-test for the controller: everything passes on what was generated, and every planted fault is found."""

import re
from dataclasses import astuple, dataclass
from functools import cache
from typing import Any

import pytest

from bench.counting import counting_library
from derive.description.mechanism import Mechanism
from tests.codesys.parts import FILES
from tests.harness import ast
from tests.harness.library import Library, compile_st
from tests.harness.parse import parse
from tests.mechanisms import catalogue
from tests.text.breakage import MECHANISM, WRONG, texts
from tests.text.statements import counted
from tests.text.units import FOLDER, compiled_shared, file_of, shared_texts, text_of

pytestmark = pytest.mark.slow

_SWITCH = "iFault"
_POSE = (*(f"v.d{axis}" for axis in "XYZ"), *(f"rot[{row}, {column}]" for row in (1, 2, 3) for column in (1, 2, 3)))


@dataclass(frozen=True)
class Planted:
    """The text of a unit, and what goes wrong in it by the number of the fault."""

    text: str
    faults: dict[int, str]


def planted(mechanism: Mechanism) -> Planted:
    """Every number that forward and inverse kinematics write, a little larger; every byte, answer and limit wrong."""
    text = text_of(mechanism)
    head, tail = text.split("END_FUNCTION_BLOCK", 1)
    axes = len(mechanism.joints)
    faults: list[str] = []
    for method, pattern in (
        ("FindPose", r"^(aBranches\[\d\]) :=[^;]*;\n"),
        ("FindPose", r"^(FindPose) :=[^;]*;\n"),
        ("SolveBranch", rf"^(a\.a[0-{max(axes - 1, 0)}]) :=[^;]*;(?:  // .*)?\n"),
        ("FindMargins", r"^(FindMargins) :=[^;]*;\n"),
        ("ReadInputs", r"^(checkLimits) := xCheckLimits;\n"),
        ("SolveBranch", r"^(SolveBranch) := Softkin_Names\.NoError;\n"),
    ):
        is_own = method != "FindMargins" or f"METHOD PROTECTED {method} " in head  # else it is that of the base
        if is_own and (axes or method not in ("SolveBranch", "ReadInputs")):
            head = _in_method(head, method, pattern, faults)
    declared = head.replace("\nVAR_INPUT\n", f"\nVAR_INPUT\n  {_SWITCH} : INT := 0;\n", 1)
    return Planted(f"{declared}END_FUNCTION_BLOCK{tail}", dict(enumerate(faults, start=1)))


def _in_method(text: str, method: str, pattern: str, faults: list[str]) -> str:
    head = re.search(rf"METHOD (?:PUBLIC|PRIVATE|PROTECTED) {method}\b.*\n", text)
    assert head is not None
    start = head.start()
    end = text.index("END_METHOD", start)

    def wrong(found: re.Match[str]) -> str:
        place = found.group(1)
        if place == "FindPose":
            return "".join(larger(entry) for entry in _POSE) + found.group()
        if place.startswith("a.a"):
            return found.group() + larger(place)
        chosen = fault(place)
        if place.startswith("aBranches"):
            return f"{found.group()}{place} := {place}*SEL({chosen}, 1.0, -1.0);\n"
        if place == "checkLimits":
            return f"checkLimits := xCheckLimits AND NOT ({chosen});\n"
        error = {"FindMargins": "NotInitialized", "SolveBranch": "InvalidCoupling"}[place]
        return f"{found.group()}IF {chosen} THEN\n  {place} := Softkin_Names.{error};\nEND_IF\n"

    def fault(place: str) -> str:
        faults.append(f"{method}: {place}")
        return f"{_SWITCH} = {len(faults)}"

    def larger(place: str) -> str:
        return f"{place} := {place} + SEL({fault(place)}, 0.0, 0.0001);\n"

    changed, count = re.subn(pattern, wrong, text[start:end], flags=re.MULTILINE)
    assert count or "aBranches" in pattern, f"nothing to spoil in {method}"
    return text[:start] + changed + text[end:]


ALL = tuple(m for _, m in catalogue())
PROGRAM = "PRG_SoftkinSelfTest"
SELF_TESTS = {path.name: path.read_text(encoding="utf-8") for path in sorted((FOLDER / "selftest").glob("*.st"))}
UNBOUNDED = 10**9
"""More operations than any case needs."""
OPERATIONS = 6
"""The column of the table of cases with the operations of a case, at most."""
WORST = 1e-6
"""What rounding the expected numbers to 6 decimals leaves is half of it."""


def self_test(mechanism: Mechanism) -> dict[str, str]:
    name = f"{mechanism.block_name}_SelfTest.st"
    return {name: SELF_TESTS[name]}


@cache
def cases(name: str) -> tuple[tuple[int, ...], ...]:
    """The rows of the table of cases of a self-test."""
    found = re.search(r"CASES : ARRAY\[0\.\.(\d+), 0\.\.(\d+)\] OF UDINT := \[([\d,\s]*)\]", SELF_TESTS[name])
    assert found is not None
    last, width, numbers = int(found[1]), int(found[2]) + 1, [int(number) for number in found[3].split(",")]
    assert len(numbers) == (last + 1) * width
    return tuple(tuple(numbers[at : at + width]) for at in range(0, len(numbers), width))


def counts(name: str) -> int:
    """How many cases a self-test has, by its own table."""
    return len(cases(name))


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


SUPPLIED = ("ReadCase", "CallBlock")
"""The methods of the base of all self-tests that a self-test supplies."""


@pytest.mark.parametrize("mechanism", ALL, ids=lambda m: m.name)
def test_every_self_test_supplies_what_the_base_calls(mechanism: Mechanism) -> None:
    """It overrides these two methods with the identical header, has no other, and adds neither inputs nor outputs to
    those of the base, so that their order is that of the base."""
    base = compiled_shared().objects["Softkin_SelfTest"]
    (own,) = parse(SELF_TESTS[f"{mechanism.block_name}_SelfTest.st"], mechanism.block_name)
    assert isinstance(own, ast.Block)
    assert (own.extends, own.implements, own.properties) == (base.name, (), ())
    assert [header(m) for m in own.methods] == [header(m) for m in base.methods if m.name in SUPPLIED]
    assert {(s.scope, s.constant) for s in own.sections} == {("VAR", True), ("VAR", False)}
    (called,) = own.body
    assert isinstance(called, ast.CallStatement) and isinstance(called.call.function, ast.Name)
    assert (called.call.function.text, called.call.arguments) == ("RunCase", ())


def header(method: ast.Routine) -> tuple[object, ...]:
    """What the header of a method says."""
    return method.name, method.access, method.returns, method.params


def test_the_base_of_self_tests_is_an_ordinary_block() -> None:
    """It implements and extends nothing; its inputs and outputs are those that every self-test has had, in their order;
    all its methods are private or protected. Alone it has no cases: one call, which fails."""
    base = compiled_shared().objects["Softkin_SelfTest"]
    assert base.implements == () and base.extends is None
    assert [p.name for p in base.params if p.scope == "VAR_INPUT"] == ["xRestart", "udiOperations"]
    assert [p.name for p in base.params if p.scope == "VAR_OUTPUT"] == OUTPUTS
    assert {m.access for m in base.methods} == {"PRIVATE", "PROTECTED"}
    assert {m.name for m in base.methods if m.access == "PROTECTED"} == {*SUPPLIED, "RunCase"}
    assert not re.search(r"\b(ABSTRACT|FINAL)\b", shared_texts()["Softkin_SelfTest.st"])
    alone = compiled_shared().new(base.name)
    alone()
    assert (alone.xDone, alone.iPassed, alone.iFailed, alone.iFirstCase, alone.sFirstCall) == (
        True, 0, 1, 0, "Initialize"
    )  # fmt: skip


OUTPUTS = ["xDone", "iPassed", "iFailed", "dWorst", "iFirstCase", "sFirstCall", "iLeftOut"]


def every_statement_of_the_base(library: Library, mechanism: Mechanism) -> None:
    """Runs them: all cases, every planted fault, no case at all, and the base alone."""
    test = library.new(f"{mechanism.block_name}_SelfTest")
    for fault in range(len(planted(mechanism).faults) + 1):
        test.kinematics.iFault = fault
        test(xRestart=True)
        while not test.xDone:
            test(xRestart=False)
    test(xRestart=False)
    test(xRestart=True, udiOperations=0)
    library.new("Softkin_SelfTest")()


def with_faults(mechanism: Mechanism) -> Library:
    """The self-test of a mechanism with a block that has faults to choose from."""
    texts = {**self_test(mechanism), file_of(mechanism): planted(mechanism).text}
    return compile_st({**shared_texts(), **texts})


@pytest.mark.parametrize("order", ["rows", "columns"])
def test_all_blocks_pass_one_after_the_other(order: str) -> None:
    """The program as a controller runs it: never more than a single case in a cycle."""
    program = compile_st(FILES, order).new(PROGRAM)
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
    """Counted while it runs: with the bound as it comes or with a small one, by turns, and with none every case within
    its own.
    """
    name = f"{mechanism.block_name}_SelfTest"
    texts = {**shared_texts(), **self_test(mechanism), file_of(mechanism): text_of(mechanism)}
    library = counting_library(texts)
    bounds = (None, 1000, min(stated_operations(name)))
    for allowed in (UNBOUNDED, bounds[ALL.index(mechanism) % 3]):
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
    return [row[OPERATIONS] for row in cases(f"{name}.st")]


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
    library = with_faults(mechanism)
    name = f"{mechanism.block_name}_SelfTest"
    test = run(library, name)
    assert (test.iFailed, test.iLeftOut, test.iFirstCase, test.sFirstCall) == (0, 0, -1, "")
    assert test.iPassed == counts(f"{name}.st")
    assert test.dWorst < WORST
    missed = []
    for number, fault in spoiled.faults.items():
        test.kinematics.iFault = number
        test(xRestart=True)
        while not (test.xDone or test.iFailed):
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
    "CartesianToAxes: a sign", "AxesToCartesian: a sign", "CartesianToAxes: an offset",
    "CartesianToAxes: two axes exchanged", "AxesToCartesian: two bytes exchanged", "CartesianToAxes: an error",
    "CartesianToAxes: a turn", "CartesianToAxes: a constant of the machine",
)  # fmt: skip


@pytest.mark.parametrize("fault", FOUND)
def test_a_mistake_in_a_formula_is_found(fault: str) -> None:
    """The self-test fails for a block with a wrong formula, and names the first case that failed."""
    library = compile_st({**texts(WRONG[fault]), **self_test(MECHANISM)})
    test = run(library, f"{MECHANISM.block_name}_SelfTest")
    assert test.iFailed > 0
    assert test.iFirstCase >= 0


def test_a_refusal_that_stays_away_is_found() -> None:
    """A tolerance of 2 instead of 1E-4: what is no rotation is accepted."""
    shared, file = dict(shared_texts()), "Softkin_RepairRotation.st"
    loose = shared[file].replace("<= 0.0001", "<= 2.0")
    assert loose != shared[file]
    library = compile_st({**shared, file: loose, **self_test(MECHANISM), file_of(MECHANISM): text_of(MECHANISM)})
    assert run(library, f"{MECHANISM.block_name}_SelfTest").iFailed > 0
