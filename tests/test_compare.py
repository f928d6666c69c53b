"""The page that compares: its table has every package that `make peers` measures, in the version that it installs."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs/COMPARE.md").read_text(encoding="utf-8")


def test_the_page_has_the_versions_that_are_measured() -> None:
    """For both arms, and in the list of what others do; the package itself on both cores."""
    pinned = "".join((ROOT / "bench" / name).read_text(encoding="utf-8") for name in ("requirements.txt", "peers.txt"))
    versions = dict(re.findall(r"^([\w-]+)==(\S+)$", pinned, re.MULTILINE))
    for package in ("eaik", "ssik", "roboticstoolbox-python", "pin", "ikpy"):
        assert PAGE.count(f" | {package} {versions[package]} | ") == 2
        assert re.search(rf"^\| \[{package}\]\(\S+\)[^|]* {re.escape(versions[package])} \|", PAGE, re.MULTILINE)
    assert all(PAGE.count(f"| softkin | `inverse_all`, {core} |") == 2 for core in ("python", "native"))
