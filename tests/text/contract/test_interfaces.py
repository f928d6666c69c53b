"""The interfaces of the library, and who writes what."""

import dataclasses
import re
from collections.abc import Iterator

import pytest

from tests.harness import ast
from tests.harness.contract import INTERFACES, plain
from tests.text.contract.blocks import CONTRACT, FILES, UNITS, blocks, library

pytestmark = pytest.mark.slow

PRIVATE = {"FindPlatform", "EndPointOnFlange", "MeetPose", "MeetPoint"}
PRIVATE |= {"FindRoot", "TryJoint", "ComputeWave", "LookAtWave", "StepOnClosure", "IsOnBranch", "JointsAt"}
PRIVATE |= {"MeetFromReference"}
_OF_INPUTS = CONTRACT.offered.keys() - {"FindNearest"}
"""The methods that write what ReadInputs has read."""
ORIENTATION = ("ISMOrientationKinematics3", "ISMToolKinematics2", "ISMOrientationKinematicsWithOriImage2")


def test_every_mechanism_has_its_block() -> None:
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
def test_the_newest_interfaces_that_fit(file: str) -> None:
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
    files = ("scara/Kin_Scara4_ZCcoupled_Type1.st", "orientation/Softkin_Wrist3.st")
    names = [name.removeprefix("TRAFO.") for file in files for name in blocks()[file].implements[:-1]]
    assert set(CONTRACT.interfaces) == {i.name for i in CONTRACT.closure(names)}


@pytest.mark.parametrize("file", UNITS)
def test_blocks_with_turns_take_the_limits_of_the_drives(file: str) -> None:
    block = blocks()[file]
    has_turns = "TRAFO.ISMKinPeriodHandling" in block.implements
    assert ("TRAFO.ISMKinematicAxisSettings" in block.implements) == has_turns
    assert ("narrow those of the block" in " ".join(block.comment.split())) == has_turns


# Every piece of text that is no comment, string or pragma.
_SILENT = re.compile(r"\(\*.*?\*\)|//[^\n]*|\{[^}]*\}|'[^'\n]*'", re.DOTALL)


def code(file: str) -> Iterator[tuple[int, str]]:
    """The numbered lines of a text without comments, strings and pragmas."""
    bare = _SILENT.sub(lambda m: "''" if m.group().startswith("'") else "\n" * m.group().count("\n"), FILES[file])
    return enumerate(bare.split("\n"), start=1)


@pytest.mark.parametrize("file", FILES)
def test_layout(file: str) -> None:
    """One statement a line, two spaces an indent, no blank at an end."""
    text = FILES[file]
    assert text.startswith("// Generated by ") and text.endswith("\n") and not text.endswith("\n\n")
    assert "\t" not in text and "\n\n\n" not in text
    for number, line in enumerate(text.split("\n"), start=1):
        assert line == line.rstrip(), f"{file}:{number}"
        assert (len(line) - len(line.lstrip())) % 2 == 0, f"{file}:{number}"
    for number, line in code(file):
        assert line.count(";") <= 1 and not re.search(r";\s*\S", line), f"{file}:{number}: two statements"


def test_names_of_objects_have_a_prefix() -> None:
    assert all(
        name.lower().startswith(("softkin_", "kin_", "mc_kin_", "prg_softkin", "isoftkin"))
        for name in library().objects
    )


@pytest.mark.parametrize("file", UNITS)
def test_only_initialize_writes_the_instance(file: str) -> None:
    """Methods that write it otherwise do not compile; ReadInputs, which may, leaves the limits to the base."""
    for method in blocks()[file].methods:
        assert method.name not in ("Check", "ReadLimits")
        if method.name == "ReadInputs":
            targets = [n.target for n in _nodes(method.body) if isinstance(n, ast.Assign)]
            members = [target.name for target in targets if isinstance(target, ast.Member)]
            assert not [name for name in members if name.startswith(("drive", "lowest", "highest"))], file
        called = {call.lower() for call in _called(method.body)}
        assert "readinputs" not in called, file
        assert method.name == "ReadInputs" or not called & {name.lower() for name in _OF_INPUTS}, file


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
        assert not calls & _OF_INPUTS or method.name in _OF_INPUTS, method.name
        written = members & set(_written(method.body))
        assert written <= {"Check": {"refusal"}, "ReadLimits": {"axes"}}.get(method.name, set()) or (
            method.name == "Initialize"
        ), method.name
    firsts = [at for at, statement in enumerate(setter.body) if "axis" in _written((statement,))]
    assert firsts and firsts == list(range(firsts[0], len(setter.body) - 1))


def _written(body: tuple[ast.Statement, ...]) -> Iterator[str]:
    for found in _nodes(body):
        if isinstance(found, ast.Assign):
            target = found.target
            while isinstance(target, ast.Member | ast.Index):
                target = target.object
            if isinstance(target, ast.Name):
                yield target.text.lower()


def _called(body: tuple[ast.Statement, ...]) -> Iterator[str]:
    """The functions and methods that statements call by their plain names, however deep."""
    for found in _nodes(body):
        if isinstance(found, ast.Call) and isinstance(found.function, ast.Name):
            yield found.function.text


def _nodes(found: object) -> Iterator[object]:
    """A node of the syntax tree and all inside it; of a tuple, those of its entries."""
    if isinstance(found, tuple):
        for one in found:
            yield from _nodes(one)
    elif dataclasses.is_dataclass(found):
        yield found
        for field in dataclasses.fields(found):
            yield from _nodes(getattr(found, field.name))
