"""The command line of an import: `import robot.urdf --base base_link --tip tool0`."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from derive.description.errors import printable
from derive.importing.arms.snapping import SNAP
from derive.importing.importing import UNITS, Options, import_robot
from derive.importing.robot import UnreadableRobot


def add_arguments(command: argparse.ArgumentParser) -> None:
    """The arguments of the command."""
    command.add_argument("robot", type=Path, help="a URDF (xacro expanded), an MJCF, or a DH table in TOML or CSV")
    command.add_argument("--base", metavar="LINK", help="the link in whose frame poses are commanded")
    command.add_argument("--tip", metavar="LINK", help="the link that is commanded: the flange, or the tool's frame")
    command.add_argument(
        "--snap",
        type=float,
        default=SNAP,
        metavar="SHARE",
        help="make axes meet, or put them at a multiple of 15°, by up to this share of the size, or of a radian",
    )
    command.add_argument("--unit", choices=tuple(UNITS), default="mm", help="the unit of length that is written")
    command.add_argument("--hold", nargs="+", default=[], metavar="AXIS", help="axes that the inverse does not move")
    command.add_argument("--out", type=Path, metavar="FILE", help="the description that is written")


def run(options: argparse.Namespace) -> int:
    """Import, write the description, and print the report. Raises `UnreadableRobot`."""
    chosen = Options(options.base, options.tip, options.snap, options.unit, tuple(options.hold))
    imported = import_robot(options.robot, chosen)
    target = options.out or Path(f"{_file_name(options.robot.stem)}.py")
    if target.exists():
        raise UnreadableRobot(f"{target}: exists, and may have been edited: name another file with --out")
    target.write_text(imported.text, encoding="utf-8")
    print(printable(imported.report))
    print(f"Written: {target}. Read it, edit it, then derive it.")
    return 0


def _file_name(stem: str) -> str:
    """A name that Python can import."""
    name = re.sub(r"\W+", "_", stem).strip("_").lower() or "robot"
    return name if name[0].isalpha() else f"robot_{name}"
