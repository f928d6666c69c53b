"""`python -m prove.klipper CHECKOUT`: the proof on the real Klipper, in batch mode.

It ends with 0 where the proof holds, 1 where not, and 3 where it cannot be run.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
from pathlib import Path

from derive.description.catalogue import catalogue
from derive.emit.around_c.package import only_positions
from derive.emit.c.package import module_name
from prove.klipper.path import way_of
from prove.klipper.session import CannotRun, prepared, run

FAILED, CANNOT = 1, 3
MOST = 0.53
"""A stepper stands within half a step of its axis; Klipper moves the time of a step by up to 25 microseconds where it
compresses steps, which adds at most so much at the speeds of these ways.
"""


def main(arguments: list[str]) -> int:
    """Run it, and print the table."""
    parser = argparse.ArgumentParser(prog="prove.klipper", description=__doc__)
    parser.add_argument("checkout", nargs="?", default="", help="a checkout of Klipper, which is not changed")
    parser.add_argument("--python", default=sys.executable, help="the Python of its host software")
    parser.add_argument("--folder", type=Path, default=Path(".klipper"), help="where it is copied to")
    parser.add_argument("--only", nargs="*", default=[], metavar="NAME", help="these mechanisms alone")
    asked = parser.parse_args(arguments)
    folder: Path = asked.folder.resolve()
    python = str(Path(asked.python).absolute())
    try:
        klipper = prepared(asked.checkout, python, folder)
    except CannotRun as reason:
        print(f"The proof on Klipper did not run: {str(reason).rstrip('.')}.", file=sys.stderr)
        return CANNOT
    machines = [m for _, m in catalogue() if only_positions(m) and (not asked.only or m.name in asked.only)]
    command = [sys.executable, "-m", "derive", "generate", "--language", "klipper", "--output", str(folder / "written")]
    subprocess.run([*command, "--only", *(m.name for m in machines)], check=True, capture_output=True)
    print("| mechanism | steps | farthest, in steps | |\n| --- | --- | --- | --- |")
    is_proven = True
    for machine in machines:
        name = machine.name
        found = run(module_name(name), way_of(machine), klipper, python, folder / "written" / "klipper")
        is_well = not found.fault and found.farthest <= MOST
        is_proven &= is_well
        print(f"| {name} | {found.count:,} | {found.farthest:.4f} | {found.fault or ('' if is_well else 'too far')} |")
    return 0 if is_proven else FAILED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
