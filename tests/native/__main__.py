"""`python -m tests.native`: build the native core, and ask it what the tests of the package ask the core in Python.

All mechanisms answer the questions of the corpus and of this folder. Of the tests of the catalogue each runs for a
mechanism of every path through the compiler; with --sweep, all others run. What has no native
half is left out: texts, Structured Text, types, derivations, and faults that are planted in the Python.
"""

import os
import subprocess
import sys
from pathlib import Path

from tests.native.build import ROOT, Unbuildable, built, is_required

OF_ALL = ("tests/native", "tests/corpus")
"""All of these are asked: `tests/conftest.py` counts them as quick here."""
CATALOGUE = "tests/catalogue"
IN_PYTHON_ALONE = (
    "tests/catalogue/loops/test_planted.py",
    "tests/catalogue/hexapod/test_planted_faults.py",
    "tests/catalogue/test_package.py",
)
"""They change the Python of a machine, or look at its files."""
PYTEST = ("-m", "pytest", "-n", "2", "--dist", "loadgroup", "-q")


def main(given: list[str]) -> int:
    """Build, run, and return the status of pytest."""
    try:
        folder = built()
    except Unbuildable as missing:
        print(f"The native half of the tests did not run: {missing}.")
        return 1 if is_required() else 0
    ignored = [f"--ignore={name}" for name in IN_PYTHON_ALONE]
    wanted = "sweep" if "--sweep" in given else "not sweep"
    return _run(folder, [*OF_ALL, CATALOGUE, *ignored, "-m", wanted, "-k", "not OnController"])


def _run(folder: Path, asked: list[str]) -> int:
    """The status of pytest on the native core."""
    path = os.pathsep.join([str(folder), *filter(None, [os.environ.get("PYTHONPATH")])])
    environment = {**os.environ, "PYTHONPATH": path, "SOFTKIN_CORE": "native"}
    return subprocess.run([sys.executable, *PYTEST, *asked], cwd=ROOT, env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
