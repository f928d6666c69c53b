"""Klipper in batch mode: its own programs, in a copy of its host software with our kinematics beside its own."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

from prove.klipper import softkin_written
from prove.klipper.path import MADE, Way
from prove.klipper.steps import Compared, Steps, compared, decoded

MICROSTEPS, FULL_STEPS, GEAR, LEAD = 16, 200, 10, 40.0
_MODULES = "cffi, greenlet, jinja2, serial, can"


class CannotRun(Exception):
    """Why the proof cannot be run, in a sentence."""


def prepared(checkout: str, python: str, folder: Path) -> Path:
    """A copy of the host software, with a micro-controller (this computer) to write for. Raises `CannotRun`.

    python: that with the modules of the host software.
    """
    if not checkout:
        raise CannotRun("no checkout of Klipper is given: make prove-klipper KLIPPER=path")
    source = Path(checkout).resolve()
    if not (source / "klippy" / "klippy.py").is_file():
        raise CannotRun(f"{source} is no checkout of Klipper")
    if subprocess.run([python, "-c", f"import {_MODULES}"], capture_output=True, check=False).returncode:
        raise CannotRun(f"{python} lacks one of {_MODULES}")
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(source, folder / "klipper", symlinks=True, ignore=shutil.ignore_patterns(".git", "*.so", "out"))
    shutil.copy(softkin_written.__file__, folder / "klipper" / "klippy" / "extras")
    config = folder / "klipper" / ".config"
    config.write_text("CONFIG_MACH_LINUX=y\n")
    for target in ("olddefconfig", "all"):
        _told(["make", "-s", target, f"PYTHON={python}"], folder / "klipper")
    return folder / "klipper"


def _told(command: list[str], folder: Path) -> str:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        raise CannotRun(f"`{' '.join(command)}` fails in {folder}: {(done.stderr or done.stdout)[-400:]}")
    return done.stdout


def run(module: str, way: Way, klipper: Path, python: str, written: Path) -> Compared:
    """A machine goes its way. written: the folder with its kinematics."""
    shutil.copytree(written, klipper / "klippy" / "kinematics", dirs_exist_ok=True)
    work = klipper.parent / module
    work.mkdir(exist_ok=True)
    (work / "printer.cfg").write_text(_configured(module, way))
    program = "\n".join(part.program for part in way.parts)
    (work / "program.gcode").write_text(f"G90\n{program}\n")
    dictionary = klipper / "out" / "klipper.dict"
    command = [python, str(klipper / "klippy" / "klippy.py"), "printer.cfg", "-i", "program.gcode"]
    try:
        _told([*command, "-o", "steps.serial", "-v", "-d", str(dictionary), "-l", "klippy.log"], work)
    except CannotRun as reason:
        last = (work / "klippy.log").read_text(errors="replace").splitlines()[-6:]
        return Compared(0, np.inf, f"Klipper ends: {reason} / {' / '.join(last)}")
    text = _told([python, str(klipper / "klippy" / "parsedump.py"), str(dictionary), "steps.serial"], work)
    frequency = float(json.loads(dictionary.read_text())["config"]["CLOCK_FREQ"])
    steps = decoded(text, {_pin(axis): axis for axis in range(len(way.home))}, frequency)
    return _each(steps, _ends(way, (work / "klippy.log").read_text(errors="replace")), way)


def _ends(way: Way, log: str) -> list[float]:
    """The times (s) at which the parts end."""
    times = [float(time) for time in re.findall(softkin_written.UNTIL.format(r"(\S+)"), log)]
    return [times[count - 1] for count in np.cumsum([part.program.count(MADE) for part in way.parts])]


def _each(steps: list[Steps], ends: list[float], way: Way) -> Compared:
    """Each part with the steps until it ends; all that follow the last but one are of the last."""
    found, begin = [], 0.0
    for part, end in zip(way.parts, [*ends[:-1], np.inf], strict=True):
        ideal = (part.axes - np.array(way.home)) / _distances(way)
        found.append(compared([one.between(begin, end) for one in steps], ideal))
        begin = end
    faults = [f"part {number}: {one.fault}" for number, one in enumerate(found, 1) if one.fault]
    return Compared(sum(one.count for one in found), max(one.farthest for one in found), "; ".join(faults))


def _distances(way: Way) -> np.ndarray:
    """A microstep of every axis, in its unit."""
    turn = 360.0 / (FULL_STEPS * MICROSTEPS * GEAR)
    return np.array([turn if axis.unit == "deg" else LEAD / (FULL_STEPS * MICROSTEPS) for axis in way.robot.AXES])


def _pin(axis: int) -> str:
    return f"gpio{2 * axis}"


def _configured(module: str, way: Way) -> str:
    lines = ["[softkin_written]", "[mcu]", "serial: /tmp/none", "[gcode_arcs]", "resolution: 0.05", "[printer]"]
    lines += [f"kinematics: softkin_{module}", "max_velocity: 100", "max_accel: 500", "square_corner_velocity: 0"]
    lines += [f"{name}: {value!r}" for name, value in way.sizes.items()]
    for byte, branch in zip(way.configuration, way.robot.CONFIGURATION[: way.robot.BRANCHES], strict=False):
        lines.append(f"{branch.name}: {branch.branches[byte - 1]}")
    for axis, one in enumerate(way.robot.AXES):
        ratio = f"gear_ratio: {GEAR}:1" if one.unit == "deg" else f"rotation_distance: {LEAD}"
        lines += [f"[stepper_{one.name.lower()}]", f"step_pin: {_pin(axis)}", f"dir_pin: gpio{2 * axis + 1}"]
        lines += [f"microsteps: {MICROSTEPS}", ratio, f"position_home: {way.home[axis]!r}"]
    return "\n".join(lines) + "\n"
