"""`make costs`: counts the instructions of a call in C on four processors, and writes `templates/costs.toml`, and the
tables of the guides.

The C of every machine of the catalogue is compiled and linked with the C library of its processor, whose sine counts
as well, and runs in QEMU with a plugin that counts. Poses are regular ones, drawn with a fixed seed.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from shutil import which
from statistics import median
from tempfile import TemporaryDirectory

from bench.costs.machine import Machine, machine_at
from derive.description.catalogue import catalogue
from derive.emit.softmotion.instructions import CALLS, FILE, Core, cores, counted, table
from derive.pipeline import workers

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
PAGES: dict[str, Sequence[str]] = {
    "docs/SPEED.md": (),
    "docs/CODESYS.md": ("Softkin_Scara2_Z", "Kin_Scara4_ZCcoupled_Type1", "Kin_Delta_P3C_Type3", "Softkin_5Axes")
    + ("Softkin_ArticulatedRobot_6DOF", "Softkin_Planar_3RRR", "Kin_Hexapod"),
}
"""The guides with a table, and the blocks that they show: all, if none is named."""
OPTIONS = ("-std=c99", "-O2", "-ffp-contract=off", "-fno-math-errno", "-static", "-I.")
PLUGIN = ("gcc", "-O2", "-fPIC", "-shared")
_PACKAGES = "gcc-arm-linux-gnueabihf gcc-aarch64-linux-gnu gcc-arm-none-eabi libnewlib-arm-none-eabi qemu-user"


@dataclass(frozen=True)
class Target(Core):
    """How C is compiled for a processor, and run."""

    tools: str
    """The begin of the names of its compiler and of its tools."""
    options: tuple[str, ...]
    emulator: tuple[str, ...]
    """QEMU's own Cortex-M7 is for whole systems: its instructions are among those of `max`."""


_HARD = ("-mthumb", "-mfloat-abi=hard")
_A9 = ("-mcpu=cortex-a9", "-mfpu=neon", *_HARD)
_M7 = ("-mcpu=cortex-m7", "-mfpu=fpv5-d16", *_HARD, "--specs=nosys.specs", "-nostartfiles")
_A53, _A72 = ("-mcpu=cortex-a53",), ("-mcpu=cortex-a72",)
TARGETS = (
    Target("Cortex-A9", 800, 0.5, "arm-linux-gnueabihf-", _A9, ("qemu-arm", "-cpu", "cortex-a9")),
    Target("Cortex-A53", 1200, 0.5, "aarch64-linux-gnu-", _A53, ("qemu-aarch64", "-cpu", "cortex-a53")),
    Target("Cortex-A72", 1500, 1.0, "aarch64-linux-gnu-", _A72, ("qemu-aarch64", "-cpu", "cortex-a72")),
    Target("Cortex-M7", 480, 0.5, "arm-none-eabi-", _M7, ("qemu-arm", "-cpu", "max")),
)


def main() -> int:
    """Measure every machine on every core and write the file; the status of the command."""
    tools = [tool for core in TARGETS for tool in (f"{core.tools}gcc", f"{core.tools}nm", core.emulator[0])]
    if missing := sorted({tool for tool in (*tools, PLUGIN[0]) if which(tool) is None}):
        print(f"make costs: {', '.join(missing)} not found; on Debian 12: apt install {_PACKAGES}", file=sys.stderr)
        return 1
    number = len(catalogue())
    with TemporaryDirectory() as folder, workers(number) as derived, ThreadPoolExecutor(2) as pool:
        plugin = Path(folder, "counted.so")
        _run(HERE, *PLUGIN, "counted.c", "-o", str(plugin))
        lines = list(pool.map(partial(_lines, plugin), derived.map(machine_at, range(number))))
    FILE.write_text("\n".join([_head(), "\n[machines]", *lines]) + "\n", encoding="utf-8")
    cores.cache_clear()
    counted.cache_clear()
    for page, blocks in PAGES.items():
        text = (ROOT / page).read_text(encoding="utf-8")
        (ROOT / page).write_text(with_table(text, blocks), encoding="utf-8")
    return 0


def with_table(text: str, blocks: Sequence[str]) -> str:
    """A guide with the table of these blocks in the place of the one that it has."""
    rows = "\n".join(table(blocks))
    return re.sub(r"^\| block \| `AxesToCartesian` \|.*?(?=\n\n)", lambda _: rows, text, flags=re.DOTALL | re.MULTILINE)


def _lines(plugin: Path, machine: Machine) -> str:
    """The line of a machine."""
    forward, inverse = machine.operations
    parts = [f"operations = [{forward}, {inverse}]"]
    with TemporaryDirectory() as folder:
        for path, text in machine.files.items():
            Path(folder, path).write_text(text, encoding="utf-8")
        for core in TARGETS:
            calls = _instructions(core, Path(folder), plugin)
            parts.append(f"{core.name} = [{', '.join(f'[{usual}, {most}]' for usual, most in calls)}]")
    line = f"{machine.name} = {{{', '.join(parts)}}}"
    print(line, flush=True)
    return line


def _instructions(core: Target, folder: Path, plugin: Path) -> list[tuple[int, int]]:
    """Median and most of each of `CALLS`, at all poses."""
    sources = [str(HERE / "machine.c"), *(path.name for path in folder.glob("*.c"))]
    _run(folder, f"{core.tools}gcc", *OPTIONS, *core.options, *sources, "-o", "program", "-lm")
    symbols = _run(folder, f"{core.tools}nm", "program").stdout.splitlines()
    mark = next(line.split()[0] for line in symbols if line.endswith(" mark"))
    marks = list(map(int, _run(folder, *core.emulator, "-plugin", f"{plugin},mark={mark}", "program").stderr.split()))
    nothing = marks[1] - marks[0]
    begins = range(2, len(marks), len(CALLS) + 1)
    found = [[marks[i + k + 1] - marks[i + k] - nothing for i in begins] for k in range(len(CALLS))]
    return [(round(median(one)), max(one)) for one in found]


def _run(folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    """What a command answers; it ends the program if it fails."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"make costs: {' '.join(command)} has the status {done.returncode}: {done.stderr}")
    return done


def _head() -> str:
    """What the file says of all machines."""
    about = (
        "# Written by `make costs`: instructions of a call in C on each processor, [median, most] of regular poses:\n"
        "# forward kinematics, the inverse on one branch, the Jacobian. And the operations of the first two.\n"
        "# The speed of a processor is no measurement: it is what microseconds assume."
    )
    speeds = (
        f'  {{name = "{core.name}", megahertz = {core.megahertz}, per_cycle = {core.per_cycle}}},' for core in TARGETS
    )
    return "\n".join([about, "cores = [", *speeds, "]"])


if __name__ == "__main__":
    sys.exit(main())
