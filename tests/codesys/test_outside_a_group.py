"""The program of the guide that calls a block outside an axis group, executed."""

import re

import pytest

from tests.codesys.guide import GUIDE, PROGRAMS, closed
from tests.codesys.parts import FILES
from tests.harness.library import compile_st


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
