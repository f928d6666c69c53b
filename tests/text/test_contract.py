"""The emitted Structured Text against the SoftMotion contract and the rules of its layout."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator
from functools import lru_cache

import pytest

from derive.command.catalogue import OUTPUT
from derive.emit.st.contract import load
from tests.harness import ast
from tests.harness.contract import INTERFACES, header, plain
from tests.harness.faults import StError
from tests.harness.library import Library, compile_st

FILES = {
    str(p.relative_to(OUTPUT / "st")): p.read_text(encoding="utf-8") for p in sorted((OUTPUT / "st").rglob("*.st"))
}
UNITS = [name for name in FILES if not name.startswith(("softkin/", "selftest/"))]
CONTRACT = load()
PRIVATE = {"FindPlatform", "EndPointOnFlange"}
PRIVATE |= {"FindRoot", "TryAt", "TryJoint", "FinishRoot"}
ORIENTATION = ("ISMOrientationKinematics3", "ISMToolKinematics2", "ISMOrientationKinematicsWithOriImage2")

# Every piece of text that is no comment, string or pragma.
_SILENT = re.compile(r"\(\*.*?\*\)|//[^\n]*|\{[^}]*\}|'[^'\n]*'", re.DOTALL)


@lru_cache
def library() -> Library:
    """All units together: parsed, with their types, names, writes and interfaces checked."""
    return compile_st(FILES)


def blocks() -> dict[str, ast.Block]:
    """The function blocks of mechanisms by file."""
    found = {name.split("/")[-1].removesuffix(".st"): name for name in UNITS}
    return {found[d.name]: d for d in library().objects.values() if isinstance(d, ast.Block) and d.name in found}


def code(file: str) -> Iterator[tuple[int, str]]:
    """The numbered lines of a text without comments, strings and pragmas."""
    bare = _SILENT.sub(lambda m: "''" if m.group().startswith("'") else "\n" * m.group().count("\n"), FILES[file])
    return enumerate(bare.split("\n"), start=1)


def test_every_mechanism_has_its_block() -> None:
    """Every mechanism has a function block."""
    assert len(blocks()) == len(UNITS) >= 20


@pytest.mark.parametrize("name", CONTRACT.interfaces)
def test_the_contract_data_agrees_with_the_stand_ins(name: str) -> None:
    """Two files condensed from the documentation, one for the emitter and one for the harness."""
    emitted, independent = CONTRACT.interfaces[name], INTERFACES[name]
    assert list(emitted.extends) == independent["extends"]
    assert dict(emitted.properties) == independent["properties"]
    assert set(emitted.methods) == set(independent["methods"])
    for method, signature in emitted.methods.items():
        wanted = independent["methods"][method]
        assert plain(signature.returns or None) == plain(wanted["returns"])
        given = [(p.scope, p.name, plain(p.type)) for p in signature.parameters]
        assert given == [(scope, parameter, plain(kind)) for scope, parameter, kind in wanted["params"]]


@pytest.mark.parametrize("file", UNITS)
def test_methods_are_those_of_the_contract(file: str) -> None:
    """A block has exactly the methods of its interfaces and its own, with the documented signatures."""
    block = blocks()[file]
    assert block.implements[-1] == "ISoftkin"
    interfaces = list(CONTRACT.closure([name.removeprefix("TRAFO.") for name in block.implements[:-1]]))
    wanted = {m: s for i in interfaces for m, s in i.methods.items()} | dict(CONTRACT.own)
    base = library().objects["Softkin_Kinematics"]
    inherited = {m.name: m for m in base.methods if m.access == "PUBLIC"}
    own = {m.name: m for m in block.methods if m.access == "PUBLIC"}
    assert not set(own) & set(inherited)
    found = {name: method for name, method in (inherited | own).items() if name in wanted}
    assert set(found) == set(wanted) and set(own) <= set(wanted)
    for name, method in found.items():
        signature = wanted[name]
        assert ("" if method.returns is None else method.returns.text) == signature.returns
        given = [(p.scope, p.name, p.type) for p in method.params]
        assert given == [(p.scope, p.name, p.type) for p in signature.parameters]
    assert {m.name for m in block.methods if m.access == "PRIVATE"} <= PRIVATE
    assert {(p.name, p.type.text) for p in block.properties} == {("NumAxes", "UDINT")}


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


def test_the_interface_has_our_own_methods() -> None:
    """Methods alone, those of the contract, with the headers that every block has: the check of types compares them."""
    interface = library().objects["ISoftkin"]
    assert isinstance(interface, ast.Interface) and interface.extends == ("__SYSTEM.IQueryInterface",)
    assert {m.name: header(m) for m in interface.methods} == {
        name: (name, s.returns, *((p.scope, p.name, p.type) for p in s.parameters)) for name, s in CONTRACT.own.items()
    }
    assert set(CONTRACT.own) == {"Diagnose", "Jacobian", "AxisVelocities", "Margins", "InitializeReason"}


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
    """A block whose method is not that of the interface does not compile."""
    file, old, new, message = WRONG_HEADERS[case]
    texts = {name: text for name, text in FILES.items() if name.startswith("softkin/") or name == SCARA}
    assert old in texts[file]
    with pytest.raises(StError, match=message):
        compile_st({**texts, file: texts[file].replace(old, new)})


def test_the_base_is_an_ordinary_block() -> None:
    """It implements nothing, so that the configurator does not list it, has no inputs, which would come before those of
    every block, and what no geometry supplies answers that nothing is initialised.
    """
    base = library().objects["Softkin_Kinematics"]
    assert base.implements == () and base.extends is None and {s.scope for s in base.sections} == {"VAR"}
    assert not re.search(r"\b(ABSTRACT|FINAL)\b", FILES["softkin/Softkin_Kinematics.st"])
    made = library().new("Softkin_Kinematics")
    assert made.call("Initialize") == "SMC_TRAFO_NOT_INITIALIZED" and made.call("IsInitialized") is False
    for method in (m for m in base.methods if m.name in CONTRACT.supplied):
        (answer,) = (s for s in method.body if isinstance(s, ast.Assign))
        if method.name == "ReasonOf":
            assert made.call("ReasonOf", iReason=1) == "not initialized"
        else:
            assert isinstance(answer.value, ast.Member) and answer.value.name == "NotInitialized"


@pytest.mark.parametrize("file", UNITS)
def test_the_newest_interfaces_that_fit(file: str) -> None:
    """A block implements the newest interfaces that fit its configuration and its kind."""
    block = blocks()[file]
    names = [name.removeprefix("TRAFO.") for name in block.implements]
    has_configuration = f"{block.name}_Config" in library().objects
    assert {"ISMKinematicWithInfo2", "ISMKinematicWithInitialization"} <= set(names)
    assert ("ISMKinematicWithConfigurations4" in names) == has_configuration
    assert f"{block.name}_ReadConfig" in library().objects or not has_configuration
    is_orientation = file.startswith("orientation/")
    is_position = "Position kinematics for a SoftMotion axis group." in block.comment
    offset = "ISMPositionKinematics_Offset2" if has_configuration else "ISMPositionKinematics_Offset"
    assert sum(name in ("ISMPositionKinematics2", offset) for name in names) == is_position
    assert sum(name in ORIENTATION for name in names) == (3 if is_orientation else 0)
    assert is_position or is_orientation or "ISMKinematicsWithOrientationImage2" in names
    assert "ISMKinPeriodHandling" not in names or has_configuration
    assert (
        "ISMOrientationKinematicsWithOriImage" not in names
    )  # it declares another GetOrientationImage than a position does
    assert not (is_orientation and (is_position or "ISMKinematicsWithOrientationImage2" in names))


def test_the_kinds_of_the_vendors_parts() -> None:
    """A position part whose flange turns freely is one still; a complete robot is none."""
    kinds = {
        "articulated/Softkin_Pos_RRR.st": "ISMPositionKinematics_Offset2",
        "articulated/Softkin_5Axes.st": "ISMKinematicsWithOrientationImage2",
        "articulated/Softkin_ArticulatedRobot_6DOF.st": "ISMKinematicsWithOrientationImage2",
        "orientation/Softkin_Wrist3.st": "ISMOrientationKinematics3",
    }
    for file, interface in kinds.items():
        assert f"TRAFO.{interface}" in blocks()[file].implements


def test_two_blocks_implement_everything() -> None:
    """Two blocks together implement every interface of the contract."""
    files = ("scara/Kin_Scara4_ZCcoupled_Type1.st", "orientation/Softkin_Wrist3.st")
    names = [name.removeprefix("TRAFO.") for file in files for name in blocks()[file].implements[:-1]]
    assert set(CONTRACT.interfaces) == {i.name for i in CONTRACT.closure(names)}


@pytest.mark.parametrize("file", FILES)
def test_layout(file: str) -> None:
    """One statement a line, two spaces an indent, capital keywords, no line that needs scrolling."""
    text = FILES[file]
    assert text.startswith("// Generated by ") and text.endswith("\n") and not text.endswith("\n\n")
    assert text.isascii() and "\t" not in text and "\n\n\n" not in text
    for number, line in enumerate(text.split("\n"), start=1):
        assert line == line.rstrip() and len(line) <= 120, f"{file}:{number}"
        assert (len(line) - len(line.lstrip())) % 2 == 0, f"{file}:{number}"
    for number, line in code(file):
        assert line.count(";") <= 1 and not re.search(r";\s*\S", line), f"{file}:{number}: two statements"
        for word in re.findall(r"\b(?:if|then|else|elsif|end_if|for|to|do|return|and|or|not|lreal|bool|var)\b", line):
            raise AssertionError(f"{file}:{number}: {word}")


def test_names_of_objects_are_unique_ignoring_case() -> None:
    """No two objects have the same name in upper or lower case, and all have a prefix."""
    names = [name.lower() for name in library().objects]
    assert len(names) == len(set(names))
    assert all(name.startswith(("softkin_", "kin_", "mc_kin_", "prg_softkin", "isoftkin")) for name in names)


@pytest.mark.parametrize("file", UNITS)
def test_names_inside_a_block_are_unique_ignoring_case(file: str) -> None:
    """No two names inside a block are the same in upper or lower case."""
    block = blocks()[file]
    members = [v.name for s in block.sections for v in s.variables] + [m.name for m in block.methods] + ["NumAxes"]
    for method in block.methods:
        own = [v.name for s in method.sections for v in s.variables]
        names = [name.lower() for name in (*members, *own)]
        assert len(names) == len(set(names)), f"{file}: {method.name}"


@pytest.mark.parametrize("file", UNITS)
def test_only_initialize_writes_the_instance(file: str) -> None:
    """What Initialize calls writes the variables of a block and what the base keeps for it, and nothing else does."""
    block, base = blocks()[file], library().objects["Softkin_Kinematics"]
    members = {v.name.lower() for owner in (block, base) for s in owner.sections for v in s.variables}
    for method in block.methods:
        written = members & set(_written(method.body))
        if method.name != "ReadInputs":
            assert not written, f"{file}: {method.name}"
        else:
            assert not [a for a in _members_of_axes(method.body) if a.startswith(("drive", "lowest", "highest"))], file
        called = {call.lower() for call in _called(method.body)}
        assert "readinputs" not in called, file
        assert method.name == "ReadInputs" or not called & {name.lower() for name in CONTRACT.offered}, file


def test_the_base_alone_reads_inputs_and_writes_limits() -> None:
    """Initialize alone calls ReadInputs, and no other method what that calls; AxisSettings writes by Softkin_SetAxis,
    whose last statements write.
    """
    base, setter = library().objects["Softkin_Kinematics"], library().objects["Softkin_SetAxis"]
    members = {v.name.lower() for s in base.sections for v in s.variables}
    for method in base.methods:
        calls = set(_called(method.body))
        assert ("ReadInputs" in calls) == (method.name == "Initialize")
        assert ("Softkin_SetAxis" in calls) == (method.name in ("Initialize", "AxisSettings"))
        assert not calls & set(CONTRACT.offered) or method.name in CONTRACT.offered, method.name
        written = members & set(_written(method.body))
        assert written <= {"Check": {"refusal"}, "ReadLimits": {"axes"}}.get(method.name, set()) or (
            method.name == "Initialize"
        ), method.name
    firsts = [at for at, statement in enumerate(setter.body) if "axis" in _written((statement,))]
    assert firsts and firsts == list(range(firsts[0], len(setter.body) - 1))


def _called(body: tuple[ast.Statement, ...]) -> Iterator[str]:
    """The functions and methods that statements call by their plain names, however deep."""
    for found in _nodes(body):
        if isinstance(found, ast.Call) and isinstance(found.function, ast.Name):
            yield found.function.text


def _members_of_axes(body: tuple[ast.Statement, ...]) -> Iterator[str]:
    """The members of the structures of axes that statements assign."""
    for found in _nodes(body):
        if isinstance(found, ast.Assign) and isinstance(found.target, ast.Member):
            yield found.target.name


def _nodes(found: object) -> Iterator[object]:
    """A node of the syntax tree and all inside it; of a tuple, those of its entries."""
    if isinstance(found, tuple):
        for one in found:
            yield from _nodes(one)
    elif dataclasses.is_dataclass(found):
        yield found
        for field in dataclasses.fields(found):
            yield from _nodes(getattr(found, field.name))


@pytest.mark.parametrize("file", UNITS)
def test_blocks_with_turns_take_the_limits_of_the_drives(file: str) -> None:
    """Exactly the blocks with turns implement the interface for the limits of drives."""
    block = blocks()[file]
    has_turns = "TRAFO.ISMKinPeriodHandling" in block.implements
    assert ("TRAFO.ISMKinematicAxisSettings" in block.implements) == has_turns
    assert ("narrow those of the block" in " ".join(block.comment.split())) == has_turns


def _written(body: tuple[ast.Statement, ...]) -> Iterator[str]:
    """The variables that statements assign, however deep."""
    for statement in body:
        if isinstance(statement, ast.Assign):
            target = statement.target
            while isinstance(target, ast.Member | ast.Index):
                target = target.object
            if isinstance(target, ast.Name):
                yield target.text.lower()
        elif isinstance(statement, ast.If | ast.Case):
            for branch in statement.branches:
                yield from _written(branch.body)
            yield from _written(statement.otherwise)
        elif isinstance(statement, ast.For | ast.While):
            yield from _written(statement.body)


@pytest.mark.parametrize("file", UNITS)
def test_inputs_are_documented(file: str) -> None:
    """Every block and every input has the attributes that the configurator shows."""
    block = blocks()[file]
    assert any("'sm_kin_libdoc'" in p for p in block.pragmas)
    axes = [p for p in block.pragmas if "'sm_kin_axes'" in p]
    assert len(axes) == (file != "orientation/Softkin_Tool.st")
    assert all(re.fullmatch(r"\{attribute 'sm_kin_axes' := '\w+(, \w+)*'\}", a) for a in axes)
    for title in (
        "**Axes**",
        "**Parameters**",
        "**Configuration**",
        "**Singularities**",
        "**Workspace**",
        "**Verification**",
    ):
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
    """The ranges of inputs are written as half-open intervals."""
    block = blocks()["scara/Kin_Scara4_ZCcoupled_Type1.st"]
    inputs = {v.name: v for s in block.sections if s.scope == "VAR_INPUT" for v in s.variables}
    assert "{attribute 'sm_kin_param_range' := ']0 .. 800]'}" in inputs["dLinkLength1"].pragmas
    assert "{attribute 'sm_kin_param_range' := '[-200 .. 200]'}" in inputs["dPitchZC"].pragmas
    assert {"xCheckLimits", "dOffsetA1", "dLowerA4", "dUpperA4"} <= inputs.keys()
