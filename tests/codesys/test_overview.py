"""The overview of all blocks: what it says of axes and tools is what the blocks say."""

import re

from derive.command.catalogue import OUTPUT
from tests.codesys.parts import FILES, all_parts

OVERVIEW = (OUTPUT / "st" / "README.md").read_text(encoding="utf-8")


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
