"""From a robot file to a description: read, snap, bring into simple form, write, and report."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from derive.description.errors import printable
from derive.description.joints import Kind
from derive.importing.arms.lines import Arm, arm_of, place_names
from derive.importing.arms.pieces import Simple, simple
from derive.importing.arms.rounded import nearly, snapped_robot
from derive.importing.arms.snapping import SNAP, Snapped, aligned
from derive.importing.arms.tasks import Followed, followed, on_axis
from derive.importing.branches import Named
from derive.importing.formats.documents import parsed
from derive.importing.formats.mjcf import read_mjcf
from derive.importing.formats.tables import read_table
from derive.importing.formats.urdf import read_urdf
from derive.importing.meshes import Meshes, meshes_of
from derive.importing.naming import axis_names
from derive.importing.report import Bounds, bounds, closed_form, neighbours, redundant, snaps, weak_axes
from derive.importing.robot import Robot, Rods, UnreadableRobot, about
from derive.importing.rods import linkage, rods_report, rods_written
from derive.importing.writing import FAR, Description, description_of, written

UNITS = {"mm": 1000.0, "m": 1.0}
_LARGEST_SNAP = 0.05
_MOST_AXES = 30
"""An arm with more of them is a snake, whose joints a program moves one by one."""
_SLIDE = 2.0
"""The assumed travel of a slide without limits, in sizes of the machine, for the bound on forward kinematics."""
Reader = Callable[[Path, str | None, str | None, float], Robot]


@dataclass(frozen=True)
class Options:
    """The options of an import: the end links of the chain, the snapping limit, the unit of length, the held joints."""

    base: str | None = None
    tip: str | None = None
    snap: float = SNAP
    unit: str = "mm"
    hold: tuple[str, ...] = ()


@dataclass(frozen=True)
class Imported:
    """A description, and the facts to report about it."""

    name: str
    text: str
    report: str
    moved: tuple[Snapped, ...]
    bounds: Bounds
    """The largest difference of the description's forward kinematics from the file's."""
    robot: Robot
    axes: tuple[str, ...]
    task: Followed
    """The task; the description's tip is that of the file, moved and turned as it says."""
    chain: Simple | None = None
    """The chain that was written; None for rods."""


def import_robot(path: Path, options: Options = Options()) -> Imported:  # noqa: B008
    """Import a robot file. Raises `UnreadableRobot` with one sentence that says what is wrong with it."""
    if options.unit not in UNITS:
        raise UnreadableRobot(f"the unit {options.unit!r} is not known; there are {', '.join(UNITS)}")
    if not 0.0 <= options.snap <= _LARGEST_SNAP:
        raise UnreadableRobot(
            f"--snap {options.snap:g} is not between 0 and {_LARGEST_SNAP:g}: more would be another machine"
        )
    try:
        robot = _reader(path)(path, options.base, options.tip, UNITS[options.unit])
    except RecursionError:
        raise UnreadableRobot(f"{path}: its parts stand in each other too deeply: no robot is that deep") from None
    if not 0 < len(robot.axes) <= _MOST_AXES:
        count = "no joint moves" if not robot.axes else f"{len(robot.axes)} joints move (at most {_MOST_AXES} can)"
        raise UnreadableRobot(f"{path}: {count} between {robot.base!r} and {robot.tip!r}")
    try:
        return _imported(robot, options) if robot.rods is None else _with_rods(robot, robot.rods, options)
    except UnreadableRobot as problem:
        raise UnreadableRobot(f"{path}: {problem}") from None


def _reader(path: Path) -> Reader:
    """The reader of a file, by the file's name; for XML, by its content."""
    suffix = path.suffix.lower()
    if suffix in (".toml", ".csv"):
        return read_table
    return read_mjcf if parsed(path).tag == "mujoco" else read_urdf


def _imported(robot: Robot, options: Options) -> Imported:
    raw = arm_of(robot)
    put_back, rounded = snapped_robot(robot, options.snap)
    axes = axis_names(robot)
    places = place_names([line.drives for line in raw.lines], axes)
    arm, turned = aligned(arm_of(put_back), places, options.snap)
    too_many = [*redundant(arm, places, options.snap)]
    if too_many and "DH table" in robot.source:
        too_many.append("A table that is read by the wrong convention has such joints: is its convention right?")
    try:
        task = followed(arm, len(axes), _held(robot, axes, options.hold))
    except UnreadableRobot as problem:
        raise UnreadableRobot("; ".join([str(problem), *too_many[:1]]).removesuffix(".")) from None
    weak = list(weak_axes(arm, task, axes))
    arm, faced = _faced(on_axis(arm, task), task)
    faced = (*_moved_tip(task, axes, options.unit), *faced)
    chain = simple(arm, axes, options.snap, about_z=task.turning == "ABOUT_Z")
    moved = (*rounded, *turned, *chain.moved)
    description = description_of(robot, arm, chain, task)
    notes = (*weak, *faced, *robot.notes)
    found = bounds(moved, raw, _strokes(robot, raw))
    report = "\n".join(
        [
            _head(robot, description, task, options.unit),
            *neighbours(raw, arm, places, options.snap, options.unit),
            *too_many,
            *([closed_form(arm, places, options.snap)] if task.turning == "FULL" else []),
            *snaps(moved, nearly(put_back), found, options.snap, options.unit),
            *notes,
        ]
    )
    text = written(robot, description, task, options.unit, notes)
    return Imported(description.name, text, _shown(report), moved, found, robot, axes, task, chain)


def _with_rods(robot: Robot, rods: Rods, options: Options) -> Imported:
    if options.hold:
        raise UnreadableRobot("every axis of its rods moves the tip: none can be held (--hold)")
    found = linkage(robot, rods, options.snap)
    moved = tuple(one for hanger in found.hangers for one in hanger.moved)
    bound = Bounds(max(h.bounds.position for h in found.hangers), max(h.bounds.rotation for h in found.hangers))
    changes = snaps(moved, (), bound, options.snap, options.unit, "The end of an arm")
    report = _shown("\n".join([*rods_report(found, options.unit), *changes, *robot.notes]))
    axes, task = found.description.axes, Followed(found.position, "NONE")
    text = rods_written(found, options.unit)
    return Imported(found.description.name, text, report, moved, bound, robot, axes, task)


def _shown(report: str) -> str:
    return "".join(c if c.isprintable() or c == "\n" else " " for c in report)


def _faced(arm: Arm, task: Followed) -> tuple[Arm, tuple[str, ...]]:
    """The arm with its tip turned so that z is the direction of the tool, and a note that says so."""
    if task.facing == 2:
        return arm, ()
    frame = np.eye(4)
    axis, angle = ((1, np.pi / 2), (0, -np.pi / 2))[task.facing]
    frame[:3, :3] = about(np.eye(3)[axis], angle)
    letter, turn = "xy"[task.facing], ("Ry(pi/2)", "Rx(-pi/2)")[task.facing]
    note = (
        f"The tip is turned by {turn}: the tool points along {letter} of the file's tip, which a description calls z."
    )
    return replace(arm, tip=arm.tip @ frame), (note,)


def _moved_tip(task: Followed, axes: Sequence[str], unit: str) -> tuple[str, ...]:
    if task.beside is None:
        return ()
    by = ", ".join(f"{letter} {value:.6g}" for letter, value in zip("xyz", task.beside, strict=True))
    return (
        f"The tip is moved by {by} {unit} (in its own frame) onto the axis of {axes[-1]}, where the position decides "
        "its heading: what stands beside the axis is a tool, whose offset is taken off the commanded position.",
    )


def _held(robot: Robot, axes: Sequence[str], names: Sequence[str]) -> tuple[int, ...]:
    """The numbers of axes, by their names or those of the file."""
    found = []
    for name in names:
        numbers = [k for k, axis in enumerate(robot.axes) if name in (axis.name, axes[k])]
        if not numbers:
            raise UnreadableRobot(f"no axis is called {name!r} (--hold); there are {', '.join(axes)}")
        found.append(numbers[0])
    return tuple(sorted(set(found)))


def _strokes(robot: Robot, arm: Arm) -> float:
    """The total travel of all slides."""
    slides = [a for a in robot.axes if a.kind is Kind.LINEAR]
    ends = [max(map(abs, a.limits)) if a.limits else math.inf for a in slides]
    return sum(end if end < FAR else _SLIDE * arm.size for end in ends)


def _head(robot: Robot, description: Description, task: Followed, unit: str) -> str:
    lines = [f"{description.name}: {robot.base} to {robot.tip} of {robot.source}, lengths in {unit}."]
    pairs = [f"{own} is {axis.name}" for own, axis in zip(description.axes, robot.axes, strict=True)]
    lines.append(f"Axes: {', '.join(pairs)}.")
    lines.append(f"Task: {_task(task)}." + _held_text(description.axes, task))
    lines.append(_branch_text(description.branches))
    lines.append("Neighbouring axes, as the file has them:")
    return "\n".join(lines)


def _task(task: Followed) -> str:
    turned = {
        "NONE": "no rotation",
        "ABOUT_Z": "the turn about z",
        "DIRECTION": "the direction of the tool's z axis",
        "PITCH": "the pitch of the tool",
        "PITCH_ROLL": "the pitch and the roll of the tool",
        "FULL": "the whole rotation",
    }[task.turning]
    return f"{', '.join(task.position) or 'no position'}; {turned}"


def _held_text(axes: Sequence[str], task: Followed) -> str:
    held = ", ".join(axes[k] for k in task.held)
    return f" Held where the reference has it: {held} (choose another with --hold)." if held else ""


def _branch_text(found: Sequence[Named]) -> str:
    if not found:
        return "Branches: none is named; the derivation names its own."
    return f"Branches: {', '.join(b.name for b in found)}."


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
    text = "take the meshes of a URDF along, into a .glb beside the description: `softkin view` shows them"
    command.add_argument("--meshes", action="store_true", help=text)
    command.add_argument("--out", type=Path, metavar="FILE", help="the description that is written")


def run(options: argparse.Namespace) -> int:
    """Import, write the description, and print the report. Raises `UnreadableRobot`."""
    chosen = Options(options.base, options.tip, options.snap, options.unit, tuple(options.hold))
    imported = import_robot(options.robot, chosen)
    target = options.out or Path(f"{_file_name(options.robot.stem)}.py")
    meshes = imported_meshes(options.robot, imported, options.unit) if options.meshes else None
    for file in (target, target.with_suffix(".glb")) if meshes and meshes.data else (target,):
        if file.exists():
            raise UnreadableRobot(f"{file}: exists, and may have been edited: name another file with --out")
    target.write_text(imported.text, encoding="utf-8")
    print(printable("\n".join([imported.report, *map(_shown, meshes.report if meshes else ())])))
    print(f"Written: {target}. Read it, edit it, then derive it.")
    if meshes and meshes.data:
        target.with_suffix(".glb").write_bytes(meshes.data)
        print(f"Written: {target.with_suffix('.glb')}. `softkin view {target}` shows it on the machine.")
    return 0


def imported_meshes(path: Path, imported: Imported, unit: str) -> Meshes:
    """The meshes of a URDF that was imported. Raises `UnreadableRobot` without the packages that read them."""
    if imported.chain is None or not imported.robot.source.endswith("(URDF)"):
        return Meshes(b"", ("No mesh was read: meshes are taken from a URDF alone.",))
    slack = 2.0 * (imported.bounds.position + imported.bounds.rotation) + 1e-6 * arm_of(imported.robot).size
    return meshes_of(path, imported.robot, imported.axes, imported.chain, UNITS[unit], slack)


def _file_name(stem: str) -> str:
    """A name that Python can import."""
    name = re.sub(r"\W+", "_", stem).strip("_").lower() or "robot"
    return name if name[0].isalpha() else f"robot_{name}"
