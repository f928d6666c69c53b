"""LinuxCNC's packages of Debian, unpacked into a folder of this project: nothing is installed."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

RELEASE = "12"
"""The release of Debian whose LinuxCNC is 2.9."""
RELEASE_FILE = Path("/etc/os-release")
PACKAGES = (
    "linuxcnc-uspace",
    "linuxcnc-uspace-dev",
    "python3-yapps",
    "libboost-python1.74.0",
    "libepoxy0",
    "libgl1",
    "libglvnd0",
    "libglx0",
    "libglu1-mesa",
    "libtirpc3",
    "libudev1",
    "libedit2",
    "libtcl8.6",
    "tcl8.6",
    "procps",
    "psmisc",
)
"""What runs without a screen: of all that LinuxCNC's packages ask for, the part that is used."""
COMMANDS = ("unshare", "mount", "gcc", "make", "apt-get", "apt-cache", "dpkg-deb", "dpkg-query")
"""What this computer brings itself."""

_OPTIONS = ("APT::Sandbox::User=root", "Acquire::Retries=1", "Acquire::http::Timeout=20", "Acquire::https::Timeout=20")
_PATIENCE = 180.0
"""Seconds that a download may take."""


class CannotRun(Exception):
    """The proof cannot be run here: the reason, in one sentence."""


@dataclass(frozen=True)
class LinuxCNC:
    """An unpacked LinuxCNC."""

    root: Path
    """The folder that holds its `usr` and `etc`."""
    version: str
    """The version of its package."""


def require_computer() -> None:
    """Raise `CannotRun` where this computer cannot give LinuxCNC a room of its own."""
    if os.geteuid() != 0:
        raise CannotRun("it needs root, to lay LinuxCNC over /usr and /etc in a mount namespace of its own")
    release = _release(RELEASE_FILE)
    if release != ("debian", RELEASE):
        raise CannotRun(f"it needs Debian {RELEASE}, which has LinuxCNC 2.9; this is {' '.join(release) or 'another'}")
    missing = [command for command in COMMANDS if shutil.which(command) is None]
    if missing:
        raise CannotRun(f"the commands {', '.join(missing)} are missing")
    tried = subprocess.run(["unshare", "--mount", "--ipc", "--pid", "--net", "--fork", "true"], check=False,
                           capture_output=True, text=True)  # fmt: skip
    if tried.returncode != 0:
        raise CannotRun(f"this computer gives root no namespaces: {tried.stderr.strip()}")


def _release(file: Path) -> tuple[str, ...]:
    """The name and the version of the system, () where it does not say them."""
    if not file.is_file():
        return ()
    lines = (line.partition("=") for line in file.read_text(encoding="utf-8").splitlines())
    said = {name: value.strip('"') for name, _, value in lines}
    return tuple(said[name] for name in ("ID", "VERSION_ID") if name in said)


def unpacked(folder: Path) -> LinuxCNC:
    """LinuxCNC in this folder, downloaded and unpacked where it is not there yet.

    Raises `CannotRun` where the packages cannot be had.
    """
    root, done = folder / "root", folder / "version"
    if not done.is_file():
        shutil.rmtree(folder, ignore_errors=True)
        root.mkdir(parents=True)
        wanted = [name for name in PACKAGES if not _is_installed(name)]
        for archive in _downloaded(wanted, folder / "archives"):
            _run(["dpkg-deb", "--extract", str(archive), str(root)], "a package cannot be unpacked")
        for part in ("bin", "sbin", "lib"):  # on the computer these are links into /usr
            if (root / part).is_dir():
                shutil.copytree(root / part, root / "usr" / part, symlinks=True, dirs_exist_ok=True)
        version = next(folder.glob("archives/linuxcnc-uspace_*")).name.split("_")[1].replace("%3a", ":")
        done.write_text(version, encoding="utf-8")
    return LinuxCNC(root, done.read_text(encoding="utf-8"))


def _is_installed(package: str) -> bool:
    """Whether the computer has it: LinuxCNC's own two packages are taken from the folder, whatever it has."""
    asked = subprocess.run(["dpkg-query", "--show", "--showformat=${db:Status-Abbrev}", package], check=False,
                           capture_output=True, text=True)  # fmt: skip
    return asked.stdout.startswith("ii") and not package.startswith("linuxcnc-")


def _downloaded(packages: Sequence[str], folder: Path) -> list[Path]:
    """The archives of these packages; the lists of packages are read again, beside it, where they are old."""
    folder.mkdir()
    command = ["apt-get", "--quiet", *(f"--option={option}" for option in _OPTIONS)]
    try:
        _run([*command, "download", *packages], "", folder)
    except CannotRun:
        lists = folder.parent / "lists"
        (lists / "partial").mkdir(parents=True)
        command += [f"--option=Dir::State::Lists={lists}", f"--option=Dir::Cache={folder.parent / 'cache'}"]
        said = "the packages of LinuxCNC cannot be downloaded"
        _run([*command, "update"], said)
        _run([*command, "download", *packages], said, folder)
        shutil.rmtree(lists)
    return sorted(folder.glob("*.deb"))


def _run(command: Sequence[str], said: str, folder: Path | None = None) -> None:
    """Run it; raise `CannotRun` with these words, and its own first error, where it fails."""
    try:
        done = subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True, timeout=_PATIENCE)
    except subprocess.TimeoutExpired:
        raise CannotRun(f"{said}: it took more than {_PATIENCE:g} s") from None
    if done.returncode != 0:
        words = [line.strip() for line in (*done.stderr.splitlines(), *done.stdout.splitlines()) if line.strip()]
        errors = [line for line in words if line.startswith("E:")]
        raise CannotRun(f"{said}: {[*errors, *words, 'no reason given'][0].removeprefix('E: ')}")
