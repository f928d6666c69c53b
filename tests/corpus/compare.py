"""Compare packages: `python -m tests.corpus.compare [--package DIR] [--with DIR] [NAME ...]`.

A package is held against what is recorded; or, with another package, against the answers of that one to the same
questions.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from tests.corpus.packages import options, use

SHOWN = 10


def main() -> int:
    """Say every difference, mechanism by mechanism; 1 where there is one."""
    parser = options(__doc__)
    parser.add_argument("--with", type=Path, dest="other", metavar="DIR", help="the folder of another softkin")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        if given.other:
            command = [
                sys.executable, "-m", "tests.corpus.record", "--package", given.other, "--output", scratch,
                *given.names,
            ]  # fmt: skip
            subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL)
        use(given.package)
        from tests.corpus.recording import NAMES, RECORDED, compared, read

        count = 0
        for name in given.names or NAMES:
            found = list(compared(read(name, Path(scratch) if given.other else RECORDED)))
            count += len(found)
            print(f"{name:32}{len(found):6} differences", *found[:SHOWN], sep="\n    ")
    print(f"{count} differences in all")
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
