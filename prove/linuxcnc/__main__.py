"""`python -m prove.linuxcnc`: the proof on the real LinuxCNC.

It ends with 0 where the proof holds, 1 where not, and 3 where it cannot be run.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from datetime import date
from pathlib import Path

from prove.linuxcnc import documented
from prove.linuxcnc.machines import MACHINES, SCARA, Machine
from prove.linuxcnc.modules import NotWritten, written, written_as
from prove.linuxcnc.packages import CannotRun, LinuxCNC, require_computer, unpacked
from prove.linuxcnc.room import require_room
from prove.linuxcnc.session import run
from prove.linuxcnc.table import table
from prove.linuxcnc.twin import Twin
from prove.linuxcnc.verdict import Verdict, verdict

FAILED, CANNOT = 1, 3
AT_ONCE = 3
"""Rooms: a machine waits more than it computes."""


def main(arguments: list[str]) -> int:
    """Run it, and print the table."""
    parser = argparse.ArgumentParser(prog="prove.linuxcnc", description=__doc__)
    parser.add_argument("--folder", type=Path, default=Path(".linuxcnc"), help="where LinuxCNC is unpacked")
    parser.add_argument("--if-possible", action="store_true", help="end with 0 where it cannot be run")
    parser.add_argument("--only", nargs="*", default=[], metavar="NAME", help="these mechanisms alone")
    asked = parser.parse_args(arguments)
    folder: Path = asked.folder.resolve()
    try:
        require_computer()
        linuxcnc = unpacked(folder / "linuxcnc")
        require_room(linuxcnc, folder / "work")
    except CannotRun as reason:
        print(f"The proof on LinuxCNC did not run: {str(reason).rstrip('.')}.", file=sys.stderr)
        return 0 if asked.if_possible else CANNOT
    machines = [machine for machine in MACHINES if not asked.only or machine.mechanism in asked.only]
    try:
        verdicts = judged(machines, linuxcnc, folder)
    except NotWritten as reason:
        print(reason, file=sys.stderr)
        return FAILED
    print(f"LinuxCNC {linuxcnc.version}, {date.today()}, without real time and without hardware:\n")
    print(table(verdicts))
    faults = [f"{one.says}: {fault}" for one in verdicts for fault in one.faults]
    if SCARA in machines:
        ill = list(documented.faults(written_as(SCARA, folder / "modules"), linuxcnc, folder / "work" / "documented"))
        faults += ill
        print(f"\nThe configuration of docs/LINUXCNC.md {'fails' if ill else 'runs to the end of its program'}.")
    for fault in faults:
        print(fault, file=sys.stderr)
    return FAILED if faults else 0


def judged(machines: Sequence[Machine], linuxcnc: LinuxCNC, folder: Path) -> list[Verdict]:
    """The verdicts on these machines, some of which run at once: each has a room of its own."""
    modules = written(machines, folder / "modules")

    def one(machine: Machine) -> Verdict:
        twin, work = Twin(machine), folder / "work" / machine.mechanism
        return verdict(twin, run(machine, modules[machine.mechanism], linuxcnc, work, twin.home()))

    with ThreadPoolExecutor(AT_ONCE) as rooms:
        return list(rooms.map(one, machines))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
