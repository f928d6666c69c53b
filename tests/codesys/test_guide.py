"""The guide and the overview: their code is code, their names exist, and what they say of tools is what the blocks
say."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from softkin import ArticulatedRobot6DOF, Scara2Z

from derive.command.catalogue import OUTPUT
from derive.description.mechanism import Role
from derive.emit.st.contract import load
from derive.emit.st.names import input_name
from tests.codesys.parts import FILES, all_parts
from tests.harness import ast
from tests.harness.library import Library, compile_st
from tests.harness.parse import parse
from tests.mechanisms import catalogue
from tests.text.values import plain

ROOT = OUTPUT.parent
GUIDE = (ROOT / "docs" / "CODESYS.md").read_text(encoding="utf-8")
OVERVIEW = (OUTPUT / "st" / "README.md").read_text(encoding="utf-8")
PROGRAMS = re.findall(r"```iecst\n(.*?)```", GUIDE, re.DOTALL)
ROBOTICS = (Path(__file__).parent / "robotics.st").read_text(encoding="utf-8")
SMC_ERROR_OF_THE_GROUP = "SMC_TRAFO_INVALID_CONSTELLATION"
LENGTHS = {
    "Scara2Z": {"arm_length_1": 300.0, "arm_length_2": 250.0},
    "ArticulatedRobot6DOF": {"a2": 300.0, "d4": 250.0, "d6": 80.0},
}
COUPLED = (Path(__file__).parent / "coupled.st").read_text(encoding="utf-8")
CNC = (Path(__file__).parent / "cnc.st").read_text(encoding="utf-8")
BLOCKS = {part.path: part for part in all_parts(FILES).values() if "." not in part.path}


def closed(program: str) -> str:
    """A program as a text: an editor of CODESYS has no closing line."""
    return program if "END_FUNCTION_BLOCK" in program else f"{program}END_PROGRAM\n"


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda p: p.split("\n")[0])
def test_its_code_parses(program: str) -> None:
    """The code in the guide parses, and uses only blocks that exist."""
    (found,) = parse(closed(program), "guide")
    assert isinstance(found, ast.Block)
    used = {v.type.text for s in found.sections for v in s.variables if v.type.text.startswith(("Softkin_", "Kin_"))}
    assert used <= set(BLOCKS)


def test_a_block_can_be_called_outside_an_axis_group() -> None:
    """The program of the guide, executed: there and back, with the numbers a SCARA of these lengths gives."""
    (program,) = (closed(p) for p in PROGRAMS if p.startswith("PROGRAM PRG_Check"))
    needed = {name: text for name, text in FILES.items() if name.startswith("softkin/") or "/Softkin_Scara2_Z." in name}
    library = compile_st({**needed, "PRG_Check": program})
    made = library.new("PRG_Check")
    for _ in range(2):
        made()
        assert made.status == "SMC_NO_ERROR"
        assert (made.frame.vT.dX, made.frame.vT.dY, made.frame.vT.dZ) == pytest.approx((259.8076211353, 400.0, 10.0))
        assert (made.back.a0, made.back.a1, made.back.a2) == pytest.approx((30.0, 60.0, 10.0))


def test_the_limits_of_a_drive_are_handed_over() -> None:
    """The lines of the guide behind that program: the way back instead of another turn."""
    (program,) = (closed(p) for p in PROGRAMS if p.startswith("PROGRAM PRG_Check"))
    (declared,) = re.findall(r"`(settings : TRAFO\.Axis_Settings)`", GUIDE)
    lines = re.findall(r"^    (settings\.limits\..*;|status := scara\.AxisSettings.*;)$", GUIDE, re.MULTILINE)
    assert len(lines) == 4
    handed = "\n".join(("IF xHanded THEN", *lines, "END_IF"))
    text = program.replace("  status :", f"  {declared};\n  xHanded : BOOL;\n  status :", 1)
    text = text.replace("axes.a0 := 30.0;", f"{handed}\naxes.a0 := -160.0;", 1)
    text = text.replace("IF status =", "data.abyData[1] := 0;\naxes.a0 := 160.0;\nIF status =", 1)
    needed = {name: t for name, t in FILES.items() if name.startswith("softkin/") or "/Softkin_Scara2_Z." in name}
    made = compile_st({**needed, "PRG_Check": text}).new("PRG_Check")
    made()
    assert made.status == "SMC_NO_ERROR" and made.back.a0 == pytest.approx(200.0)
    made.xHanded = True
    made()
    assert made.status == "SMC_NO_ERROR" and made.back.a0 == pytest.approx(-160.0)
    assert made.scara.axes[0].driveLimited == 1.0


def _renamed(texts: dict[str, str]) -> dict[str, str]:
    """The texts with another name for the output `Error` of the library's blocks, which ours never declare."""
    return {name: re.sub(r"\bError\b", "ErrorOut", text) for name, text in texts.items()}


def _demo() -> tuple[Any, Any]:
    """The program of the guide and its group, on stand-ins."""
    (program,) = (closed(p) for p in PROGRAMS if p.startswith("PROGRAM PRG_Demo"))
    needed = {name: text for name, text in FILES.items() if name.startswith("softkin/") or "/Softkin_Scara2_Z." in name}
    texts = {
        "robotics": ROBOTICS,
        "Groups": "VAR_GLOBAL\n  Scara : AXIS_GROUP_REF_SM3;\nEND_VAR\n",
        "PRG_Demo": program,
    }
    library = compile_st({**needed, **_renamed(texts)})
    return library.new("PRG_Demo"), library.constant("Scara")


def test_every_program_of_the_guide_is_executed() -> None:
    """A new listing needs a test that runs it: these are the ones that have one."""
    heads = [program.split("\n")[0].split()[1] for program in PROGRAMS]
    assert heads == ["PRG_Demo", "ScaraWithTool", "PRG_Check", "PRG_Ask", "PRG_Cnc"]


def _asking(*blocks: str, **texts: str) -> tuple[Library, Any, Any]:
    """The program that asks a group, its library, and the group, which has these blocks and is enabled."""
    (program,) = (closed(p) for p in PROGRAMS if p.startswith("PROGRAM PRG_Ask"))
    wanted = tuple(f"/{name}." for name in blocks)
    needed = {n: t for n, t in FILES.items() if n.startswith("softkin/") or any(name in n for name in wanted)}
    group = "VAR_GLOBAL\n  Scara : AXIS_GROUP_REF_SM3;\nEND_VAR\n"
    own = {"robotics": ROBOTICS, "Groups": group, "PRG_Ask": program, **texts}
    library = compile_st({**needed, **_renamed(own)})
    found = library.constant("Scara")
    found.isEnabled = True
    return library, library.new("PRG_Ask"), found


def test_a_program_asks_the_instance_of_the_group() -> None:
    """The program of the guide, at a point that the arms miss by 50: of the instance that the group has, with its
    dimensions; and nothing is found in a group that has none, or whose block is replaced.
    """
    library, ask, group = _asking("Softkin_Scara2_Z")
    ask()
    assert ask.xFound is False and ask.sWhy == ""
    arms = library.new("Softkin_Scara2_Z")
    arms.dArmLength1, arms.dArmLength2 = 300.0, 250.0
    assert arms.call("Initialize") == "SMC_NO_ERROR"
    group.kinematics = arms
    ask.frame.vT.dX, ask.axes.a1, ask.axes.a0 = 600.0, 30.0, 10.0
    ask.data.abyData[0] = 1
    ask()
    assert ask.xFound and ask.sWhy == "A2: out of reach [u]" and ask.dMissing == pytest.approx(50.0) and ask.iTurn == 0
    in_python = Scara2Z(arm_length_1=300.0, arm_length_2=250.0).singularity((10.0, 30.0, 0.0))
    margins = list(in_python.margins.values())
    assert ask.status == "SMC_NO_ERROR" and ask.aMargins[: ask.iMargins] == pytest.approx(margins)
    group.isEnabled = False
    ask.sWhy = "old"
    ask()
    assert ask.xFound is False and ask.sWhy == "old"


def test_what_it_asks_changes_nothing() -> None:
    """The instance of the group is the same after it as before."""
    library, ask, group = _asking("Softkin_Scara2_Z")
    arms = group.kinematics = library.new("Softkin_Scara2_Z")
    arms.dArmLength1, arms.dArmLength2 = 300.0, 250.0
    arms.call("Initialize")
    names = [name for made in type(arms).__mro__ for name in getattr(made, "__slots__", ())]
    state = [plain(getattr(arms, name)) for name in names]
    ask()
    assert ask.xFound and len(names) > 10 and [plain(getattr(arms, name)) for name in names] == state


def test_a_coupled_group_is_asked_by_its_parts() -> None:
    """The query fails in a group whose kinematics is a coupling; the block of the guide gives out its parts."""
    (coupled,) = (p for p in PROGRAMS if p.startswith("FUNCTION_BLOCK ScaraWithTool"))
    texts = {"coupled": COUPLED, "ScaraWithTool": coupled.replace("TRAFO.Kin_Coupled", "Kin_Coupled")}
    library, ask, group = _asking("Softkin_Scara2_Z", "Softkin_CAxis", **texts)
    machine = group.kinematics = library.new("ScaraWithTool")
    machine.dArmLength1, machine.dArmLength2 = 300.0, 250.0
    assert machine.call("Initialize") == "SMC_NO_ERROR"
    ask()
    assert ask.xFound is False and ask.robot is None
    assert machine.itfArms is machine.arms and machine.itfTool is machine.tool
    assert machine.itfArms.call("InitializeReason") == machine.itfTool.call("InitializeReason") == ""


def test_the_demo_moves_a_group() -> None:
    """Its program, executed on stand-ins that are always done: power, then the moves in order, the other elbow, then
    jogging.
    """
    demo, group = _demo()
    done: list[tuple[int, float, float, int]] = []
    for _ in range(60):
        demo()
        place = group.position.c
        elbow = group.kinConfig.abyData[0]
        if (now := (group.moved, place.X, place.Y, elbow)) not in done[-1:]:
            done.append(now)
    assert done == [
        (0, 0.0, 0.0, 0), (1, 400.0, 100.0, 0), (2, 400.0, -100.0, 0), (2, 400.0, -100.0, 2), (1, 400.0, -100.0, 2)
    ]  # fmt: skip
    arms = Scara2Z(arm_length_1=300.0, arm_length_2=250.0)
    for _, x, y, byte in done[1:]:  # within reach of the arms that the guide names
        arms.inverse(((x, y, 0.0), np.eye(3)), (byte or 1, 0, 0))
    assert not group.refused and demo.iStep == 100 and not demo.jog.Busy
    demo.xJog = True
    demo.axForward[0] = True
    demo()
    assert demo.jog.Busy and group.moved == 3


STEPS = (0, 10, 20, 30, 40, 100)


@pytest.mark.parametrize("step", STEPS)
def test_the_demo_ends_in_its_error_step_and_begins_again(step: int) -> None:
    """A fault in any step stops every block; a reset begins from power again, and the moves are made."""
    demo, group = _demo()
    for _ in range(80):
        demo()
        if demo.iStep == step:
            break
    group.fault, demo.xJog = SMC_ERROR_OF_THE_GROUP, step == 100
    for _ in range(6):
        demo()
    moved = group.moved
    assert demo.iStep == 900 and demo.iFailed == step and demo.eError == SMC_ERROR_OF_THE_GROUP and not demo.xJog
    for _ in range(20):
        demo()
    assert demo.iStep == 900 and group.moved == moved, "it waits, and moves nothing"
    demo.xReset = True
    for _ in range(80):
        demo()
    assert demo.iStep == 100 and not demo.xReset and demo.eError == "SMC_NO_ERROR" and not group.refused


def test_a_coupled_block_initialises_its_parts() -> None:
    """The block of the guide, executed on a stand-in of its base, which wants both parts."""
    (program,) = (p for p in PROGRAMS if p.startswith("FUNCTION_BLOCK ScaraWithTool"))
    user = """PROGRAM User
VAR
  machine : ScaraWithTool;
  status : SM3_Error.SMC_ERROR;
  length : LREAL;
END_VAR
machine(dArmLength1 := length, dArmLength2 := length);
status := machine.Initialize();
END_PROGRAM
"""
    wanted = ("/Softkin_Scara2_Z.", "/Softkin_CAxis.")
    needed = {n: t for n, t in FILES.items() if n.startswith("softkin/") or any(name in n for name in wanted)}
    texts = {"base": COUPLED, "coupled": program.replace("TRAFO.Kin_Coupled", "Kin_Coupled"), "user": user}
    made = compile_st({**needed, **texts}).new("User")
    made()
    assert made.status == "SMC_TRAFO_NOT_INITIALIZED" and made.machine.calls == 0
    made.length = 250.0
    made()
    assert made.status == "SMC_NO_ERROR" and made.machine.calls == 1
    assert made.machine.arms.initialized and made.machine.tool.initialized


@pytest.mark.parametrize("machine", [Scara2Z, ArticulatedRobot6DOF])
def test_the_zero_poses_that_it_calls_singular_are(machine: type) -> None:
    """A stretched SCARA, and a 6R arm whose axes A4 and A6 are in line."""
    robot = machine(**LENGTHS[machine.__name__])
    count = len(machine.AXES)
    assert robot.singularity((0.0,) * count).is_singular
    assert not robot.singularity((10.0, 30.0, 40.0, 20.0, 50.0, 60.0)[:count]).is_singular


def test_g_code_on_a_position_and_an_orientation_block() -> None:
    """Its program, executed on stand-ins of the wrappers: the point of the axes, and from it these axes again."""
    (program,) = (closed(p) for p in PROGRAMS if p.startswith("PROGRAM PRG_Cnc"))
    wanted = ("/Softkin_Scara2_Z.", "/Softkin_CAxis.")
    needed = {n: t for n, t in FILES.items() if n.startswith("softkin/") or any(name in n for name in wanted)}
    made = compile_st({**needed, **_renamed({"cnc": CNC, "PRG_Cnc": program})}).new("PRG_Cnc")
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
    (program,) = (closed(p) for p in PROGRAMS if p.startswith("PROGRAM PRG_Cnc"))
    name = unit.split("/")[1]
    (mechanism,) = (m for _, m in catalogue() if m.block_name == name)
    lengths = ", ".join(f"{input_name(p)} := {p.nominal:.6f}" for p in mechanism.parameters if p.role is not Role.FLAG)
    for old, new in (
        ("arms : Softkin_Scara2_Z", f"arms : {name}"),
        ("dArmLength1 := 300.0, dArmLength2 := 250.0", lengths),
        ("  IF status = SM3_Error.SMC_ERROR.SMC_NO_ERROR THEN\n    status := tool.Initialize();\n  END_IF\n", ""),
        (", KinOri := tool", ""),
        ("  tool : Softkin_CAxis;\n", ""),
    ):
        assert old in program
        program = program.replace(old, new)
    needed = {n: t for n, t in FILES.items() if n.startswith("softkin/") or n == f"{unit}.st"}
    made = compile_st({**needed, **_renamed({"cnc": CNC, "PRG_Cnc": program})}).new("PRG_Cnc")
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


@pytest.mark.parametrize("page", ["docs/CODESYS.md", "generated/st/README.md", "README.md"])
def test_links_lead_somewhere(page: str) -> None:
    """Every link of a page leads to a file that exists, and to a heading that exists in it."""
    path = ROOT / page
    text = path.read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)]+)\)", text):
        file, _, anchor = target.partition("#")
        where = (path.parent / file).resolve() if file else path
        assert where.exists(), target
        if anchor:
            assert anchor in {
                _anchor(h) for h in re.findall(r"^#+ (.*)$", where.read_text(encoding="utf-8"), re.MULTILINE)
            }


def _anchor(heading: str) -> str:
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def test_the_overview_lists_every_block() -> None:
    """The overview lists every block with its file and the axes that the block declares."""
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
