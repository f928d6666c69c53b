"""The programs of the guide, executed on stand-ins: moves, queries, a coupled kinematics; in a group and outside."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from softkin import Scara2Z

from tests.codesys.guide import GUIDE, library_of, program_of
from tests.harness.library import Library
from tests.text.values import plain

ROBOTICS = (Path(__file__).parent / "robotics.st").read_text(encoding="utf-8")
SMC_ERROR_OF_THE_GROUP = "SMC_TRAFO_INVALID_CONSTELLATION"
COUPLED = (Path(__file__).parent / "coupled.st").read_text(encoding="utf-8")
WITH_TOOL = program_of("FUNCTION_BLOCK ScaraWithTool EXTENDS TRAFO.Kin_Coupled").replace("TRAFO.Kin_", "Kin_")


def _asking(*blocks: str, name: str = "PRG_Ask", **texts: str) -> tuple[Library, Any, Any]:
    """The program that asks a group, its library, and the group, which has these blocks and is enabled."""
    group = "VAR_GLOBAL\n  Machine : AXIS_GROUP_REF_SM3;\nEND_VAR\n"
    own = {"robotics": ROBOTICS, "Groups": group, name: program_of(f"PROGRAM {name}"), **texts}
    library = library_of(*blocks, **own)
    found = library.constant("Machine")
    found.isEnabled = True
    return library, library.new(name), found


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
    library, ask, group = _asking("Softkin_Scara2_Z")
    arms = group.kinematics = library.new("Softkin_Scara2_Z")
    arms.dArmLength1, arms.dArmLength2 = 300.0, 250.0
    arms.call("Initialize")
    names = [name for made in type(arms).__mro__ for name in getattr(made, "__slots__", ())]
    state = [plain(getattr(arms, name)) for name in names]
    ask()
    assert ask.xFound and len(names) > 10 and [plain(getattr(arms, name)) for name in names] == state


def test_a_program_checks_a_line() -> None:
    """The program of the guide: a line of the group's SCARA that it can follow, with the velocity that its axes allow,
    one that ends out of reach, and one past a stretched arm.
    """
    library, program, group = _asking("Softkin_Scara2_Z", name="PRG_Line")
    program.xCheck = True
    program()
    assert not program.check.xBusy and not program.xMayMove, "no kinematics is active"
    arms = group.kinematics = library.new("Softkin_Scara2_Z")
    arms.dArmLength1, arms.dArmLength2 = 300.0, 250.0
    assert arms.call("Initialize") == "SMC_NO_ERROR"
    robot = Scara2Z(arm_length_1=300.0, arm_length_2=250.0)
    axes = robot.inverse(((400.0, 100.0, 0.0), np.eye(3)), (1, 0, 0))
    program.axes.a0, program.axes.a1, program.axes.a2 = axes
    program.aLimits[:3] = 90.0, 180.0, 100.0
    cases = ((400.0, -100.0, True, ""), (600.0, 0.0, False, "A2: out of reach [u]"), (549.9, 0.0, False, ""))
    for x, y, may, why in cases:
        program.target.vT.dX, program.target.vT.dY = x, y
        for program.xCheck in (False, *[True] * 11):
            program()
        assert program.check.xDone and program.xMayMove is may and program.check.sReason == why
        if may:
            assert program.check.dLargestStep < 1.0 and program.check.iChecked == 101
            rates = [np.linalg.solve(np.array(robot.jacobian(row))[:2, :2], (0.0, -1.0)) for row in _line(robot)]
            wanted = min(np.radians((90.0, 180.0)) / np.abs(rates).max(axis=0))
            assert program.dVelocity == pytest.approx(wanted, rel=1e-4)


def test_a_program_teaches_offsets() -> None:
    """The program of the guide: three marks of a SCARA with other offsets, and these are found."""
    _, program, _ = _asking("Softkin_Scara2_Z", name="PRG_Teach")
    true = Scara2Z(arm_length_1=300.0, arm_length_2=250.0, offset_a1=1.8, offset_a2=-2.5, offset_z=0.4)
    for axes in ((20.0, 60.0, 10.0), (-40.0, 100.0, 35.0), (70.0, -50.0, 20.0)):
        program.axes.a0, program.axes.a1, program.axes.a2 = axes
        place = program.frame.vT
        place.dX, place.dY, place.dZ = true.forward(axes)[0].position
        for program.xMeasured in (True, False):
            program()
    assert program.teach.iRows == 3 and not program.xFits
    for program.xSolve in [True] * 100:
        program()
    assert program.xFits and program.aOffsets[:3] == pytest.approx((1.8, -2.5, 0.4), abs=1e-6)


def _line(robot: Scara2Z) -> list[tuple[float, ...]]:
    """Axis values along the line of the guide."""
    return [robot.inverse(((400.0, y, 0.0), np.eye(3)), (1, 0, 0)) for y in np.linspace(100.0, -100.0, 101)]


def test_a_coupled_group_is_asked_by_its_parts() -> None:
    """The query fails in a group whose kinematics is a coupling; the block of the guide gives out its parts."""
    library, ask, group = _asking("Softkin_Scara2_Z", "Softkin_CAxis", coupled=COUPLED, ScaraWithTool=WITH_TOOL)
    machine = group.kinematics = library.new("ScaraWithTool")
    machine.dArmLength1, machine.dArmLength2 = 300.0, 250.0
    assert machine.call("Initialize") == "SMC_NO_ERROR"
    ask()
    assert ask.xFound is False and ask.robot is None
    assert machine.itfArms is machine.arms and machine.itfTool is machine.tool
    assert machine.itfArms.call("InitializeReason") == machine.itfTool.call("InitializeReason") == ""


def test_a_coupled_block_initialises_its_parts() -> None:
    """The block of the guide, executed on a stand-in of its base, which wants both parts."""
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
    made = library_of("Softkin_Scara2_Z", "Softkin_CAxis", base=COUPLED, coupled=WITH_TOOL, user=user).new("User")
    made()
    assert made.status == "SMC_TRAFO_NOT_INITIALIZED" and made.machine.calls == 0
    made.length = 250.0
    made()
    assert made.status == "SMC_NO_ERROR" and made.machine.calls == 1
    assert made.machine.arms.initialized and made.machine.tool.initialized


def test_a_block_can_be_called_outside_an_axis_group() -> None:
    """The program of the guide, executed: there and back, with the numbers a SCARA of these lengths gives."""
    made = library_of("Softkin_Scara2_Z", PRG_Check=program_of("PROGRAM PRG_Check")).new("PRG_Check")
    for _ in range(2):
        made()
        assert made.status == "SMC_NO_ERROR"
        assert (made.frame.vT.dX, made.frame.vT.dY, made.frame.vT.dZ) == pytest.approx((259.8076211353, 400.0, 10.0))
        assert (made.back.a0, made.back.a1, made.back.a2) == pytest.approx((30.0, 60.0, 10.0))


def test_the_limits_of_a_drive_are_handed_over() -> None:
    """The lines of the guide behind that program: the way back instead of another turn."""
    program = program_of("PROGRAM PRG_Check")
    (declared,) = re.findall(r"`(settings : TRAFO\.Axis_Settings)`", GUIDE)
    lines = re.findall(r"^    (settings\.limits\..*;|status := scara\.AxisSettings.*;)$", GUIDE, re.MULTILINE)
    assert len(lines) == 4
    handed = "\n".join(("IF xHanded THEN", *lines, "END_IF"))
    text = program.replace("  status :", f"  {declared};\n  xHanded : BOOL;\n  status :", 1)
    text = text.replace("axes.a0 := 30.0;", f"{handed}\naxes.a0 := -160.0;", 1)
    text = text.replace("IF status =", "data.abyData[1] := 0;\naxes.a0 := 160.0;\nIF status =", 1)
    made = library_of("Softkin_Scara2_Z", PRG_Check=text).new("PRG_Check")
    made()
    assert made.status == "SMC_NO_ERROR" and made.back.a0 == pytest.approx(200.0)
    made.xHanded = True
    made()
    assert made.status == "SMC_NO_ERROR" and made.back.a0 == pytest.approx(-160.0)
    assert made.scara.axes[0].driveLimited == 1.0
