"""The base block, and what every block supplies to it."""

import re

import pytest

from tests.harness import ast
from tests.harness.contract import header
from tests.text.contract.blocks import CONTRACT, FILES, UNITS, blocks, library

pytestmark = pytest.mark.slow


def test_the_base_is_an_ordinary_block() -> None:
    """It implements nothing, so that the configurator does not list it, has no inputs, which would come before those of
    every block, and what no geometry supplies answers that it is impossible.
    """
    base = library().objects["Softkin_Kinematics"]
    assert base.implements == () and base.extends is None and {s.scope for s in base.sections} == {"VAR"}
    assert not re.search(r"\b(ABSTRACT|FINAL)\b", FILES["softkin/Softkin_Kinematics.st"])
    made = library().new("Softkin_Kinematics")
    assert made.call("Initialize") == "SMC_TRAFO_INVALID_CONSTELLATION" and made.call("IsInitialized") is False
    for method in (m for m in base.methods if m.name in CONTRACT.supplied):
        (answer,) = (s for s in method.body if isinstance(s, ast.Assign))
        if method.name == "ReasonOf":
            assert made.call("ReasonOf", iReason=1) == "impossible"
        else:
            assert isinstance(answer.value, ast.Member) and answer.value.name == "Impossible"


@pytest.mark.parametrize("file", UNITS)
def test_every_block_supplies_what_the_base_calls(file: str) -> None:
    """A block overrides each protected method of the base that its interfaces need, with the identical header; what it
    declares besides is public or private. A flange that keeps its orientation needs fewer.
    """
    block, base = blocks()[file], library().objects["Softkin_Kinematics"]
    assert block.extends == base.name
    offered = {m.name: header(m) for m in base.methods if m.access == "PROTECTED"}
    supplied = {m.name: header(m) for m in block.methods if m.access == "PROTECTED"}
    assert supplied == {name: offered[name] for name in supplied}
    names = [name.removeprefix("TRAFO.") for name in block.implements]
    interfaces = CONTRACT.closure([name for name in names if name in CONTRACT.interfaces])
    public = {m for i in interfaces for m in i.methods}
    needed = {n for n in CONTRACT.supplied if n not in CONTRACT.supplied_for or CONTRACT.supplied_for[n] & public}
    if "layout.eFreedom := Softkin_Names.FixedOrientation;" in FILES[file]:
        needed -= CONTRACT.supplied_turning
    assert needed <= set(supplied) <= needed | set(CONTRACT.overridable)
    assert set(offered) == set(CONTRACT.supplied) | set(CONTRACT.overridable) | set(CONTRACT.offered)


def test_what_a_block_need_not_supply() -> None:
    """Whatever only some blocks supply some do and some do not, and the method that needs it is the base's own."""
    base = {m.name for m in library().objects["Softkin_Kinematics"].methods if m.access == "PUBLIC"}
    for name, methods in CONTRACT.supplied_for.items():
        assert methods <= base
        assert {name in {m.name for m in block.methods} for block in blocks().values()} == {True, False}
    with_more = [file for file, block in blocks().items() if "TestLimits" in {m.name for m in block.methods}]
    assert 3 <= len(with_more) <= 10 and "planar/Kin_PCC.st" in with_more


@pytest.mark.parametrize("method", ["FindImage", "FindProjection"])
def test_what_is_true_of_most_flanges_stands_in_the_base(method: str) -> None:
    """A flange that may hang upside down is the only one whose block overrides how it stands at rest."""
    assert method in CONTRACT.overridable
    own = [file for file, block in blocks().items() if method in {m.name for m in block.methods}]
    assert own == ["scara/Kin_Scara4_CCZC_ZCcoupled.st"]
    assert "xFlangeDown" in FILES[own[0]]


@pytest.mark.parametrize("file", UNITS)
def test_the_base_tests_the_limits_that_the_reasons_name(file: str) -> None:
    """Where the base tests the limits of the axes, the numbers that Describe gives are those of their reasons."""
    block, text = blocks()[file], FILES[file]
    axes = _axes_of(block)
    first = [int(number) for number in re.findall(r"Softkin_AddAxis\(.* iLow := (\d+)\);", text)]
    assert len(first) == len(axes)
    if "TestLimits" in {m.name for m in block.methods}:
        assert set(first) == {0}
        return
    reasons = dict(re.findall(r"^  (\d+): ReasonOf := '(.*)';$", text, re.MULTILINE))
    for axis, number in zip(axes, first, strict=True):
        assert reasons[str(number)].startswith(f"{axis}: below its lower limit")
        has_turns = re.search(rf"layout\.aAxisOfTurn\[\d\] := {axes.index(axis)};", text) is not None
        assert ("name one inside" in reasons[str(number + 1)]) == has_turns
        assert reasons[str(number + 1 + has_turns)].startswith(f"{axis}: above its upper limit")


def _axes_of(block: ast.Block) -> list[str]:
    return [name for p in block.pragmas if "'sm_kin_axes'" in p for name in p.split("'")[3].split(", ")]
