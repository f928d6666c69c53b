"""The guide: its code is code, and what it names exists."""

import re

import pytest
from softkin import ArticulatedRobot6DOF, Scara2Z

from derive.emit.st.contract import load
from tests.codesys.guide import GUIDE, PROGRAMS, closed
from tests.codesys.parts import FILES, all_parts
from tests.harness import ast
from tests.harness.parse import parse
from tests.text.units import FOLDER

LENGTHS = {
    "Scara2Z": {"arm_length_1": 300.0, "arm_length_2": 250.0},
    "ArticulatedRobot6DOF": {"a2": 300.0, "d4": 250.0, "d6": 80.0},
}
BLOCKS = {part.path: part for part in all_parts(FILES).values() if "." not in part.path}


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda p: p.split("\n")[0])
def test_its_code_parses(program: str) -> None:
    """The code in the guide parses, and uses only blocks that exist."""
    (found,) = parse(closed(program), "guide")
    assert isinstance(found, ast.Block)
    used = {v.type.text for s in found.sections for v in s.variables if v.type.text.startswith(("Softkin_", "Kin_"))}
    assert used <= set(BLOCKS)


def test_every_program_of_the_guide_is_executed() -> None:
    """A new listing needs a test that runs it: these are the ones that have one."""
    heads = [program.split("\n")[0].split()[1] for program in PROGRAMS]
    assert heads == ["PRG_Demo", "ScaraWithTool", "PRG_Check", "PRG_Ask", "PRG_Cnc"]


def test_the_objects_that_it_counts() -> None:
    """What an import of the SCARA brings."""
    text = (FOLDER / "scara" / "Softkin_Scara2_Z.xml").read_text(encoding="utf-8")
    kinds = ("pou ", "dataType ", "globalVars ", "Interface ", "Method ")
    pous, types, lists, interfaces, methods = (text.count(f"<{kind}") for kind in kinds)
    assert (lists, interfaces) == (1, 1)
    told = " ".join(GUIDE.split())
    assert (
        f"{pous + types + 2} objects ({pous} POUs, {types} types, a list, an interface) with {methods} methods" in told
    )
    assert f"the same {pous + types + 2} objects and {methods} methods" in told


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
