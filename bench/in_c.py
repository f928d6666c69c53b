"""One branch in C beside a branch that is written by hand (`bench/hand/six_axis.c`): `python -m bench.in_c`."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[1]
SOURCES = ROOT / "generated" / "python" / "native"
BY_HAND = Path(__file__).parent / "hand" / "six_axis.c"
OPTIONS = ("-std=c99", "-O2", "-ffp-contract=off", "-fno-math-errno", "-D_POSIX_C_SOURCE=200809L")


def main() -> int:
    """Compile, measure and print; the status of the command."""
    with TemporaryDirectory() as folder:
        program = Path(folder, "bench")
        sources = (BY_HAND, SOURCES / "articulatedrobot_6dof.c", SOURCES / "softkin.c")
        command = [*shlex.split(os.environ.get("CC", "gcc")), *OPTIONS, f"-I{SOURCES}", *map(str, sources)]
        try:
            subprocess.run([*command, "-o", str(program), "-lm"], check=True)
        except OSError:
            print("One branch in C: there is no compiler.")
            return 0
        done = subprocess.run([program], capture_output=True, text=True, check=True)
    generated, by_hand, worst = map(float, done.stdout.split())
    print("One branch in C, processor time of a call (KUKA KR6 R900, gcc -O2), least of all rounds")
    print(
        f"  {'generated: numbers tested, turns chosen, singular poses':60}{generated:8.0f} ns{generated / by_hand:7.2f}"
    )
    print(f"  {'by hand: reach alone':60}{by_hand:8.0f} ns{1.0:7.2f}")
    print(f"  worst error of the generated one: {worst:.0e} mm")
    return 0


if __name__ == "__main__":
    sys.exit(main())
