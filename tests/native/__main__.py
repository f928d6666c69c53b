"""`python -m tests.native`: build the native core, and ask it what the tests of the package ask the core in Python.

What has no native half is left out here: texts, types, derivations, and faults that are planted in the Python.
"""

from __future__ import annotations

import os
import subprocess
import sys

from tests.native.build import ROOT, Unbuildable, built

ASKED = ("tests/native", "tests/corpus", "tests/catalogue")
IN_PYTHON_ALONE = (
    "tests/catalogue/loops/test_planted.py",
    "tests/catalogue/hexapod/test_planted_faults.py",
    "tests/catalogue/test_package.py",
)
"""They change the Python of a machine, or look at its files."""


def main(given: list[str]) -> int:
    """Build, run, and return the status of pytest; given: further arguments for it."""
    try:
        folder = built()
    except Unbuildable as missing:
        print(f"The native half of the tests did not run: {missing}.")
        return 1 if os.environ.get("CI") else 0
    path = os.pathsep.join([str(folder), *filter(None, [os.environ.get("PYTHONPATH")])])
    ignored = [f"--ignore={name}" for name in IN_PYTHON_ALONE]
    command = [sys.executable, "-m", "pytest", "-n", "2", "--dist", "loadgroup", "-q", *ASKED, *ignored, *given]
    return subprocess.run(
        command, cwd=ROOT, env={**os.environ, "PYTHONPATH": path, "SOFTKIN_CORE": "native"}, check=False
    ).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
