"""Compare two packages by the corpus: `python -m tests.corpus.compare`."""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

GENERATED = Path(__file__).resolve().parents[2] / "generated" / "python"


def options(description: str | None) -> argparse.ArgumentParser:
    """What every command takes."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("names", nargs="*", metavar="NAME", help="mechanisms; without one, all")
    parser.add_argument("--package", type=Path, default=GENERATED, metavar="DIR", help="the folder that holds softkin")
    return parser


def use(folder: Path) -> None:
    """Import softkin from a folder; it must not be imported yet."""
    assert "softkin" not in sys.modules
    sys.path.insert(0, str(folder.resolve()))
    import softkin

    found = Path(softkin.__file__).resolve()
    assert found.is_relative_to(folder.resolve()), f"softkin is {found}, and not in {folder}"


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
