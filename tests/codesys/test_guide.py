"""The guide and the overview: code is code, what they name exists, and the program that executes G code runs."""

import re
from pathlib import Path

import pytest
from softkin import ArticulatedRobot6DOF, Scara2Z

from derive.command.catalogue import OUTPUT
from derive.description.mechanism import Role
from derive.emit.softmotion.inputs import wanted_name
from derive.emit.st.contract import load
from tests.codesys.guide import GUIDE, PROGRAMS, closed, library_of, program_of
from tests.codesys.parts import FILES, all_parts, parts_of
from tests.harness import ast
from tests.harness.parse import parse
from tests.mechanisms import catalogue
from tests.text.units import FOLDER

LENGTHS = {
    "Scara2Z": {"arm_length_1": 300.0, "arm_length_2": 250.0},
    "ArticulatedRobot6DOF": {"a2": 300.0, "d4": 250.0, "d6": 80.0},
}
BLOCKS = {part.path: part for part in all_parts(FILES).values() if "." not in part.path}


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda p: p.split("\n")[0])
def test_its_code_parses(program: str) -> None:
    (found,) = parse(closed(program), "guide")
    assert isinstance(found, ast.Block)
    used = {v.type.text for s in found.sections for v in s.variables if v.type.text.startswith(("Softkin_", "Kin_"))}
    assert used <= set(BLOCKS)


def test_every_program_of_the_guide_is_executed() -> None:
    """A new listing needs a test that runs it: these are the ones that have one."""
    heads = [program.split("\n")[0].split()[1] for program in PROGRAMS]
    assert heads == ["ScaraWithTool", "PRG_Check", "PRG_Ask", "PRG_Cnc", "PRG_Line", "PRG_Teach"]


def test_the_objects_that_it_counts() -> None:
    """What an import of the SCARA brings, and what is pasted of it: the base block, and its methods once."""
    text = (FOLDER / "scara" / "Softkin_Scara2_Z.xml").read_text(encoding="utf-8")
    kinds = ("pou ", "dataType ", "globalVars ", "Interface ", "Method ")
    pous, types, lists, interfaces, methods = (text.count(f"<{kind}") for kind in kinds)
    assert (lists, interfaces) == (1, 1)
    told = " ".join(GUIDE.split())
    assert (
        f"{pous + types + 2} objects ({pous} POUs, {types} types, a list, an interface) with {methods} methods" in told
    )
    pasted = ("scara/Softkin_Scara2_Z", "softkin/Softkin_Kinematics", "softkin/ISoftkin")
    methods = sum(part.kind == "METHOD" for name in pasted for part in parts_of(FILES[f"{name}.st"]))
    assert f"{pous + types + 3} objects and {methods} methods" in told


def test_every_choice_it_names_exists() -> None:
    """Every input, profile and status that the guide names exists in the product."""
    declared = {
        line.split()[0] for part in BLOCKS.values() for line in part.declaration.split("\n") if line.startswith("  ")
    }
    for name in ("xElbowRight", "xElbowAutomatic", "xElbowSingular", "xTcpAbove", "dOffsetA1"):
        assert name in declared, name
    contract = load()
    assert set(re.findall(r"PROFILE=(\w+)", GUIDE)) <= set(contract.spelling["profiles"])
    statuses = set(re.findall(r"^\| `(SMC_\w+)` \|", GUIDE, re.MULTILINE))
    assert statuses == {c.value.split(".")[-1] for c in contract.names[0].constants} - {"SMC_NO_ERROR"}


@pytest.mark.parametrize("machine", [Scara2Z, ArticulatedRobot6DOF])
def test_the_zero_poses_that_it_calls_singular_are(machine: type) -> None:
    """A stretched SCARA, and a 6R arm whose axes A4 and A6 are in line."""
    robot = machine(**LENGTHS[machine.__name__])
    count = len(machine.AXES)
    assert robot.singularity((0.0,) * count).is_singular
    assert not robot.singularity((10.0, 30.0, 40.0, 20.0, 50.0, 60.0)[:count]).is_singular


OVERVIEW = (OUTPUT / "st" / "README.md").read_text(encoding="utf-8")


def test_the_overview_lists_every_block() -> None:
    row = r"^\| \[`(\w+)`\]\((\S+)\.st\) \| \[picture\]\(pictures/\1\.png\) \| ([^|]+) \| ([^|]+) \|"
    rows = re.findall(row, OVERVIEW, re.MULTILINE)
    assert {f"{path}.st" for _, path, _, _ in rows} == {
        name for name in FILES if not name.startswith(("softkin/", "selftest/"))
    }
    for block, path, axes, tools in rows:
        (part,) = (p for p in all_parts({path: FILES[f"{path}.st"]}).values() if p.path == block)
        named = f"'sm_kin_axes' := '{axes.replace(' ', ', ')}'"
        assert named in part.declaration if axes != "none" else "sm_kin_axes" not in part.declaration
        assert tools == _tools(block, path, part.declaration)


def _tools(block: str, path: str, declaration: str) -> str:
    """By SoftMotion's rules: an image of dof zero takes any offset, of dof one those along vU, of dof three none."""
    if "ISMOrientationKinematics3" in declaration:
        return "with a position block"
    code = all_parts({path: FILES[f"{path}.st"]})["METHOD", f"{block}.Describe"].implementation
    if "ISMKinematicsWithOrientationImage2" in declaration:
        image = "Turning" if "layout.isDirection := TRUE;" in code else "Fixed"
    else:
        (image,) = re.findall(r"^layout\.eFreedom := Softkin_Names\.(\w+)Orientation;", code, re.MULTILINE)
    return {"Fixed": "any", "Turning": "along the axis it turns about", "Free": "none"}[image]


CNC = (Path(__file__).parent / "cnc.st").read_text(encoding="utf-8")


def test_g_code_on_a_position_and_an_orientation_block() -> None:
    """Its program, executed on stand-ins of the wrappers: the point of the axes, and from it these axes again."""
    program = program_of("PROGRAM PRG_Cnc")
    made = library_of("Softkin_Scara2_Z", "Softkin_CAxis", cnc=CNC, PRG_Cnc=program).new("PRG_Cnc")
    made.actual.a0, made.actual.a1, made.actual.a2, made.actual.a3 = 30.0, 60.0, -10.0, 25.0
    made.setPoint.dX = 400.0
    made()
    point = made.toPoint.pi
    assert made.xReady and made.status == "SMC_NO_ERROR"
    assert (point.dX, point.dY, point.dZ, point.dC) == pytest.approx((259.8076211353, 400.0, -10.0, 115.0))
    for name in ("dX", "dY", "dZ", "dC"):
        setattr(made.setPoint, name, getattr(point, name))
    made()
    target = made.target
    assert (target.a0, target.a1, target.a2, target.a3) == pytest.approx((30.0, 60.0, -10.0, 25.0))
    made.setPoint.dX = 900.0  # out of reach: an error, and the last target stays
    made()
    assert made.status == "SMC_AXIS_INVERSE_TRAFO_EXCEEDING_POSLIMITS" and made.target.a0 == pytest.approx(30.0)


ALONE = {
    "gantry/Softkin_Gantry3": (10.0, -20.0, 30.0),
    "parallel/Kin_P2C_Type1": (35.0, 5.0),
    "parallel/Softkin_Delta_C": (20.0, 10.0, 15.0),
    "articulated/Softkin_Pos_RRR": (20.0, 45.0, -30.0),
}
"""Blocks that stand alone, and axis values of each in its default configuration."""


@pytest.mark.parametrize("unit", ALONE)
def test_g_code_on_a_block_that_stands_alone(unit: str) -> None:
    """The program of the guide without its orientation block, on blocks of other kinds: the point of the axes, and from
    it these axes again.
    """
    program = program_of("PROGRAM PRG_Cnc")
    name = unit.split("/")[1]
    (mechanism,) = (m for _, m in catalogue() if m.block_name == name)
    lengths = ", ".join(f"{wanted_name(p)} := {p.nominal:.6f}" for p in mechanism.parameters if p.role is not Role.FLAG)
    for old, new in (
        ("arms : Softkin_Scara2_Z", f"arms : {name}"),
        ("dArmLength1 := 300.0, dArmLength2 := 250.0", lengths),
        ("  IF status = SM3_Error.SMC_ERROR.SMC_NO_ERROR THEN\n    status := tool.Initialize();\n  END_IF\n", ""),
        (", KinOri := tool", ""),
        ("  tool : Softkin_CAxis;\n", ""),
    ):
        assert old in program
        program = program.replace(old, new)
    made = library_of(name, cnc=CNC, PRG_Cnc=program).new("PRG_Cnc")
    axes = ALONE[unit]
    fields = [f"a{k}" for k in range(len(axes))]
    for field, value in zip(fields, axes, strict=True):
        setattr(made.actual, field, value)
        setattr(made.toAxes.Axes, field, value)
    made()
    assert made.xReady and not made.toPoint.ErrorOut
    made.setPoint._assign(made.toPoint.pi)
    made()
    assert made.status == "SMC_NO_ERROR"
    assert [getattr(made.target, field) for field in fields] == pytest.approx(axes)
