"""The guide and the overview: their code is code, their names exist, and what they say of tools is what the blocks
say."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from softkin import Scara2Z

from derive.__main__ import OUTPUT
from derive.emit.st.contract import load
from tests.codesys.parts import FILES, all_parts
from tests.harness import ast
from tests.harness.library import compile_st
from tests.harness.parse import parse

ROOT = OUTPUT.parent
GUIDE = (ROOT / "docs" / "CODESYS.md").read_text(encoding="utf-8")
OVERVIEW = (OUTPUT / "st" / "README.md").read_text(encoding="utf-8")
PROGRAMS = re.findall(r"```iecst\n(.*?)```", GUIDE, re.DOTALL)
ROBOTICS = (Path(__file__).parent / "robotics.st").read_text(encoding="utf-8")
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


def test_the_demo_moves_a_group() -> None:
    """Its program, executed on stand-ins that are always done: power, then the moves in order, the other elbow, then
    jogging.
    """
    (program,) = (closed(p) for p in PROGRAMS if p.startswith("PROGRAM PRG_Demo"))
    needed = {name: text for name, text in FILES.items() if name.startswith("softkin/") or "/Softkin_Scara2_Z." in name}
    texts = {
        "robotics": ROBOTICS,
        "Groups": "VAR_GLOBAL\n  Scara : AXIS_GROUP_REF_SM3;\nEND_VAR\n",
        "PRG_Demo": program,
    }
    library = compile_st({**needed, **texts})
    demo, group = library.new("PRG_Demo"), library.constant("Scara")
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
    members = all_parts({path: FILES[f"{path}.st"]})
    if "ISMKinematicsWithOrientationImage2" in declaration:
        code = members["METHOD", f"{block}.GetFlangeOrientationImageWithOri"].implementation
    else:
        code = members["METHOD", f"{block}.GetOrientationImage"].implementation
    image = re.findall(r"^oriInfo\.dof := Softkin_Names\.(\w+)Orientation;", code, re.MULTILINE)
    return {"Fixed": "any", "Turning": "along the axis it turns about", "Free": "none"}[image[-1]]
