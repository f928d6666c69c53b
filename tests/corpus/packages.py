"""Which package `softkin` is asked: found before anything imports it."""

import argparse
import sys
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
