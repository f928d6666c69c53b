"""One machine in LinuxCNC, from its start to the record of what it did."""

from __future__ import annotations

import json
import shutil
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from prove.linuxcnc import settings
from prove.linuxcnc.machines import LETTERS, Machine, Pose
from prove.linuxcnc.modules import Module
from prove.linuxcnc.packages import LinuxCNC
from prove.linuxcnc.poses import Reals
from prove.linuxcnc.room import run_inside

DISPLAY = Path(__file__).with_name("display.py")
"""What LinuxCNC runs as its screen."""
BESIDE = 10.0
"""Millimetres in X and Y that a machine moves to show that it goes on; in identity each joint, in its own unit."""
_WRONG = 1e12
"""No machine takes this for a parameter."""
_PATIENCE = 120.0
"""Seconds that a machine may take in all."""


@dataclass(frozen=True)
class Stage:
    """A part of what was done."""

    name: str
    joints: Reals
    """What the kinematics answered (N, joints), one row a period."""
    motors: Reals
    """What the motors were commanded (N, joints): a spline through the same, a few periods later."""
    poses: Reals
    """What LinuxCNC asked the kinematics for (N, 6)."""
    in_program: NDArray[np.bool_]
    """Whether a program moves (N,)."""
    in_world: NDArray[np.bool_]
    """Whether the pose is jogged (N,): else, and without a program, joints are jogged one by one."""
    before: Mapping[str, Any]
    after: Mapping[str, Any]
    said: list[str]
    """What LinuxCNC complained about."""


@dataclass(frozen=True)
class Record:
    """What a machine did."""

    stages: Mapping[str, Stage]
    fault: str
    """Why it was not brought to its end, "" where it was."""
    lost: int
    """Periods that were not recorded."""
    seconds: float


def run(machine: Machine, module: Module, linuxcnc: LinuxCNC, work: Path, home: Mapping[str, float]) -> Record:
    """Build the module, start LinuxCNC with this machine, do all it is asked, and stop it again."""
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    _write(machine, module, work, home)
    began = time.monotonic()
    start = f"halcompile --install {module.file.name} && linuxcnc -r machine.ini"
    code = run_inside(linuxcnc, work, ["bash", "-c", start], work / "log.txt", _PATIENCE)
    seconds = time.monotonic() - began
    if not (work / "record.json").is_file():
        words = (work / "log.txt").read_text(encoding="utf-8", errors="replace").splitlines()
        why = "it took too long" if code == -1 else "; ".join(words[-3:])
        return Record({}, f"LinuxCNC did not come up: {why} (all of it: {work / 'log.txt'})", 0, seconds)
    return _record(machine, work, seconds)


def _write(machine: Machine, module: Module, work: Path, home: Mapping[str, float]) -> None:
    """All files that LinuxCNC reads."""
    optional = "".join(f"#define SOFTKIN_WITH_{part} 1\n" for part in ("JACOBIAN", "FRAMES"))
    (work / module.file.name).write_text(optional + module.file.read_text(encoding="utf-8"), encoding="utf-8")
    shutil.copy(DISPLAY, work / "display.py")
    (work / "display.py").chmod(0o755)
    texts = {
        "machine.ini": settings.ini(machine, module.name, home),
        "machine.hal": settings.hal(machine, module.setting(machine)),
        "first.ngc": settings.program(machine, second=False),
        "second.ngc": settings.program(machine, second=True),
        "plan.json": json.dumps(_plan(machine, module)),
    }
    for name, text in texts.items():
        (work / name).write_text(text, encoding="utf-8")


def _plan(machine: Machine, module: Module) -> dict[str, object]:
    """What the display does."""
    end = {letter: value for move in machine.second.program for letter, value in move.to.items()}
    parameter, value = next(iter(machine.sizes.items()))
    return {
        "joints": len(machine.first.joints),
        "kinds": settings.kinds(machine),
        "first": machine.first.joints,
        "tool": [_upright(machine), f"G43.1 Z{machine.raised}"] if machine.tool else [],
        "second": machine.second.joints,
        "jog": ["XYZABC".index(letter) for letter in machine.letters],
        "unreachable": _line(machine.unreachable),
        "back": _line({letter: value + (BESIDE if letter in "XY" else 0.0) for letter, value in end.items()}),
        "on": _line(end),
        "parameter": [module.pin(parameter), repr(float(value)), repr(_WRONG)],
        "identity": [_line(dict.fromkeys(machine.letters, sign * BESIDE), "G91") for sign in (1.0, -1.0)],
        "through": [_line(pose) for pose in machine.through or ()],
    }


def _upright(machine: Machine) -> list[float]:
    """The first joint values with the tool along Z, where a tool may be made longer without a jump."""
    return [value if joint in machine.linear else 0.0 for joint, value in enumerate(machine.first.joints)]


def _line(pose: Pose, counted: str = "G90") -> str:
    return " ".join([counted, "G1", f"F{settings.FEED}", *(f"{letter}{value:.9g}" for letter, value in pose.items())])


def _record(machine: Machine, work: Path, seconds: float) -> Record:
    """What the display has written."""
    said = json.loads((work / "record.json").read_text(encoding="utf-8"))
    width, joints = len(settings.sampled(machine)), len(machine.first.joints)
    rows = np.fromfile(work / "samples.bin").reshape(-1, width)
    poses = np.zeros((len(rows), len(LETTERS)))
    for column, letter in enumerate(machine.letters, 2 * joints):
        poses[:, LETTERS.index(letter)] = rows[:, column]
    stages = {}
    for stage in said["stages"]:
        part = slice(*stage["rows"])
        coarse, motors = rows[part, :joints], rows[part, joints : 2 * joints]
        in_program, in_world = rows[part, -2] > 0.5, rows[part, -1] > 0.5
        stages[stage["name"]] = Stage(
            stage["name"], coarse, motors, poses[part], in_program, in_world, stage["before"], stage["after"],
            stage["said"],
        )  # fmt: skip
    return Record(stages, said["fault"], said["lost"], seconds)
