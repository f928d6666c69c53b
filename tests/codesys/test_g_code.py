"""The program of the guide that executes G code, on stand-ins of the wrappers."""

from pathlib import Path

import pytest

from derive.description.mechanism import Role
from derive.emit.softmotion.inputs import wanted_name
from tests.codesys.guide import PROGRAMS, closed, renamed
from tests.codesys.parts import FILES
from tests.harness.library import compile_st
from tests.mechanisms import catalogue

CNC = (Path(__file__).parent / "cnc.st").read_text(encoding="utf-8")


def test_g_code_on_a_position_and_an_orientation_block() -> None:
    """Its program, executed on stand-ins of the wrappers: the point of the axes, and from it these axes again."""
    (program,) = (closed(p) for p in PROGRAMS if p.startswith("PROGRAM PRG_Cnc"))
    wanted = ("/Softkin_Scara2_Z.", "/Softkin_CAxis.")
    needed = {n: t for n, t in FILES.items() if n.startswith("softkin/") or any(name in n for name in wanted)}
    made = compile_st({**needed, **renamed({"cnc": CNC, "PRG_Cnc": program})}).new("PRG_Cnc")
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
    needed = {n: t for n, t in FILES.items() if n.startswith("softkin/") or n == f"{unit}.st"}
    made = compile_st({**needed, **renamed({"cnc": CNC, "PRG_Cnc": program})}).new("PRG_Cnc")
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
