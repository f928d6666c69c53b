"""`python -m prove.linuxcnc`: the proof on the real LinuxCNC.

It ends with 0 where the proof holds, 1 where not, and 3 where it cannot be run.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from prove.linuxcnc.machines import MACHINES
from prove.linuxcnc.modules import written
from prove.linuxcnc.packages import CannotRun, require_computer, unpacked
from prove.linuxcnc.room import require_room
from prove.linuxcnc.session import run
from prove.linuxcnc.table import table
from prove.linuxcnc.twin import Twin
from prove.linuxcnc.verdict import verdict

FAILED, CANNOT = 1, 3


def main(arguments: list[str]) -> int:
    """Run it, and print the table."""
    parser = argparse.ArgumentParser(prog="prove.linuxcnc", description=__doc__)
    parser.add_argument("--folder", type=Path, default=Path("build/linuxcnc-2.9"), help="where LinuxCNC is unpacked")
    parser.add_argument("--if-possible", action="store_true", help="end with 0 where it cannot be run")
    parser.add_argument("--only", nargs="*", default=[], metavar="NAME", help="these mechanisms alone")
    asked = parser.parse_args(arguments)
    folder: Path = asked.folder.resolve()
    try:
        require_computer()
        linuxcnc = unpacked(folder / "linuxcnc")
        require_room(linuxcnc, folder / "work")
    except CannotRun as reason:
        print(f"The proof on LinuxCNC did not run: {reason}.", file=sys.stderr)
        return 0 if asked.if_possible else CANNOT
    machines = tuple(machine for machine in MACHINES if not asked.only or machine.mechanism in asked.only)
    modules = written(machines, folder / "modules")
    verdicts = []
    for machine in machines:
        twin, module = Twin(machine), modules[machine.mechanism]
        record = run(machine, module, linuxcnc, folder / "work" / machine.mechanism, twin.home())
        verdicts.append(verdict(twin, record))
    print(f"LinuxCNC {linuxcnc.version}, without real time and without hardware:\n")
    print(table(verdicts))
    faults = [f"{one.says}: {fault}" for one in verdicts for fault in one.faults]
    print("\n".join(["", *faults]) if faults else "", file=sys.stderr)
    return FAILED if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
