"""The configuration of docs/LINUXCNC.md, run as it stands there, but for the screen."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from prove.linuxcnc.machines import SCARA, Machine
from prove.linuxcnc.modules import Module
from prove.linuxcnc.packages import LinuxCNC
from prove.linuxcnc.room import run_inside
from prove.linuxcnc.session import DISPLAY
from prove.linuxcnc.twin import Twin
from prove.linuxcnc.verdict import ALIKE

_GUIDE = Path(__file__).parents[2] / "docs" / "LINUXCNC.md"
_FILE = re.compile(r"^`(scara\.\w+)`:\n\n```\w*\n(.*?)^```$", re.MULTILINE | re.DOTALL)
_SIZE = re.compile(r"^setp softkin\.(\S+) (\S+)$", re.MULTILINE)
_WORD = re.compile(r"([XYZC])(-?[\d.]+)")
_PATIENCE = 60.0
"""Seconds."""


def files() -> dict[str, str]:
    """The files of the guide, by their names."""
    return dict(_FILE.findall(_GUIDE.read_text(encoding="utf-8")))


def machine(texts: Mapping[str, str]) -> Machine:
    """The machine whose dimensions they set."""
    sizes = {name.replace("-", "_"): float(value) for name, value in _SIZE.findall(texts["scara.hal"])}
    return Machine(
        SCARA.says, SCARA.mechanism, sizes, SCARA.letters, SCARA.first, SCARA.second, SCARA.unreachable, linear=(2,)
    )


def end(texts: Mapping[str, str]) -> dict[str, float]:
    """Where the program ends, by letter."""
    return {letter: float(value) for letter, value in _WORD.findall(texts["scara.ngc"])}


def faults(module: Module, linuxcnc: LinuxCNC, work: Path) -> Iterator[str]:
    """What is wrong when LinuxCNC runs them: that the program ends elsewhere, or that anything is complained about."""
    shutil.rmtree(work, ignore_errors=True)
    work.mkdir(parents=True)
    texts = files()
    shutil.copy(module.file, work)
    shutil.copy(DISPLAY, work / "display.py")
    (work / "display.py").chmod(0o755)
    plan = json.dumps({"joints": 4, "program": "scara.ngc"})
    for name, text in {**texts, "plan.json": plan}.items():
        (work / name).write_text(text.replace("DISPLAY = axis", "DISPLAY = ./display.py"), encoding="utf-8")
    start = f"halcompile --install {module.file.name} && linuxcnc -r scara.ini"
    run_inside(linuxcnc, work, ["bash", "-c", start], work / "log.txt", _PATIENCE)
    if not (work / "record.json").is_file():
        yield f"the configuration of the guide does not run (see {work / 'log.txt'})"
        return
    record = json.loads((work / "record.json").read_text(encoding="utf-8"))
    yield from (f"the configuration of the guide: {said}" for said in record["said"])
    pose = Twin(machine(texts)).pose(record.get("joints", SCARA.first.joints))
    there, counted = end(texts), float(sum(record.get("joints", [0.0])[k] for k in (0, 1, 3)))
    apart = np.abs(pose[:3] - [there[letter] for letter in "XYZ"]).max()
    if not max(apart, abs(counted - there["C"])) <= 1e3 * ALIKE:
        yield f"the configuration of the guide: its program ends {apart:.1e} away from where it says"
