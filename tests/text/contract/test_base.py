"""The base block, inputs, and interfaces of our own, as the library has them."""

from __future__ import annotations

import re

import pytest

from tests.harness import ast
from tests.harness.contract import header
from tests.harness.faults import StError
from tests.harness.library import compile_st
from tests.text.contract.blocks import CONTRACT, FILES, UNITS, blocks, library

pytestmark = pytest.mark.slow


def test_the_base_is_an_ordinary_block() -> None:
    """It implements nothing, so that the configurator does not list it, and has no inputs: they would come before those
    of every block.
    """
    base = library().objects["Softkin_Kinematics"]
    assert base.implements == () and base.extends is None and {s.scope for s in base.sections} == {"VAR"}
    assert not re.search(r"\b(ABSTRACT|FINAL)\b", FILES["softkin/Softkin_Kinematics.st"])
    made = library().new("Softkin_Kinematics")
    assert made.call("Initialize") == "SMC_TRAFO_INVALID_CONSTELLATION" and made.call("IsInitialized") is False


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


@pytest.mark.parametrize("file", UNITS)
def test_inputs_are_documented(file: str) -> None:
    """Every block and every input has the attributes that the configurator shows."""
    block = blocks()[file]
    assert any("'sm_kin_libdoc'" in p for p in block.pragmas)
    axes = [p for p in block.pragmas if "'sm_kin_axes'" in p]
    assert len(axes) == (file != "orientation/Softkin_Tool.st")
    assert all(re.fullmatch(r"\{attribute 'sm_kin_axes' := '\w+(, \w+)*'\}", a) for a in axes)
    for title in (
        "**Axes**", "**Parameters**", "**Configuration**", "**Singularities**", "**Workspace**", "**Verification**",
    ):  # fmt: skip
        assert title in block.comment
    for given in (v for s in block.sections if s.scope == "VAR_INPUT" for v in s.variables):
        assert given.comment and given.initial is not None
        kind, prefix = given.type.text, given.name[0]
        assert {"LREAL": "d", "BOOL": "x", "INT": "i"}[kind] == prefix
        interval = [p for p in given.pragmas if "'sm_kin_param_range'" in p]
        assert len(interval) == (kind != "BOOL")
        for pragma in interval:
            assert re.search(r":= '[\[\]](-inf|-?\d+) \.\. (\+inf|-?\d+)[\[\]]'\}", pragma)
            assert "-inf" not in pragma or "']-inf" in pragma
            assert "+inf" not in pragma or "+inf['" in pragma
        unit = [p.split("'")[3] for p in given.pragmas if "'sm_kin_param_unit'" in p]
        assert (
            unit
            or kind != "LREAL"
            or given.name in ("dMinType2Margin", "dWarningDistance")
            or given.name.startswith("dCoupling")
        ), "a number"
        if given.name.startswith(("dLinkLength", "dArmLength")):
            assert unit == ["u"]


def test_vendor_ranges_are_half_open() -> None:
    block = blocks()["scara/Kin_Scara4_ZCcoupled_Type1.st"]
    inputs = {v.name: v for s in block.sections if s.scope == "VAR_INPUT" for v in s.variables}
    assert "{attribute 'sm_kin_param_range' := ']0 .. 800]'}" in inputs["dLinkLength1"].pragmas
    assert "{attribute 'sm_kin_param_range' := '[-200 .. 200]'}" in inputs["dPitchZC"].pragmas
    assert {"xCheckLimits", "dOffsetA1", "dLowerA4", "dUpperA4"} <= inputs.keys()


def test_the_interface_has_our_own_methods() -> None:
    """Methods alone, those of the contract, with the headers that every block has: the check of types compares them."""
    interface = library().objects["ISoftkin"]
    assert isinstance(interface, ast.Interface) and interface.extends == ("__SYSTEM.IQueryInterface",)
    assert {m.name: header(m) for m in interface.methods} == {
        name: (name, s.returns, *((p.scope, p.name, p.type) for p in s.parameters)) for name, s in CONTRACT.own.items()
    }
    of_axes = {"Jacobian", "AxisVelocities", "AxisAccelerations", "Margins"}
    assert set(CONTRACT.own) == {"Diagnose", "InitializeReason", *of_axes, *(f"{name}From" for name in of_axes)}


SCARA = "scara/Softkin_Scara2_Z.st"
INTERFACE, BASE = "softkin/ISoftkin.st", "softkin/Softkin_Kinematics.st"
WRONG_HEADERS = {
    "a method more": (
        INTERFACE, "METHOD InitializeReason", "METHOD Explain : BOOL\nEND_METHOD\n\nMETHOD InitializeReason",
        "Softkin_Scara2_Z lacks the method Explain of ISoftkin",
    ),
    "another access": (BASE, "METHOD PUBLIC Margins", "METHOD PROTECTED Margins", "ISoftkin.Margins must be public"),
    "another name": (INTERFACE, "  iTurn : INT;", "  iPeriod : INT;", "the header of Diagnose is not that of ISoftkin"),
    "another type": (INTERFACE, "aMargins : ARRAY[0..7]", "aMargins : ARRAY[0..8]", "the header of Margins"),
    "another result": (INTERFACE, "InitializeReason : STRING(255)", "InitializeReason : STRING(80)", "the header of"),
    "another order": (
        INTERFACE, "  aTwist : ARRAY[0..5] OF LREAL;\n  a : TRAFO.AXISPOS_REF;",
        "  a : TRAFO.AXISPOS_REF;\n  aTwist : ARRAY[0..5] OF LREAL;", "the header of AxisVelocities",
    ),
    "another base": (INTERFACE, " EXTENDS __SYSTEM.IQueryInterface", "", "extends nothing that a query finds"),
    "a base that is not there": (INTERFACE, "__SYSTEM.IQueryInterface", "__SYSTEM.IQuery", "unknown interface"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG_HEADERS)
def test_another_header_is_refused(case: str) -> None:
    file, old, new, message = WRONG_HEADERS[case]
    texts = {name: text for name, text in FILES.items() if name.startswith("softkin/") or name == SCARA}
    assert old in texts[file]
    with pytest.raises(StError, match=message):
        compile_st({**texts, file: texts[file].replace(old, new)})
