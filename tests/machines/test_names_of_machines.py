"""Machines that are called like something of the Python package: both can be had, each by its own name."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
import softkin

from derive.emit.python import package
from derive.emit.python.entries import class_name, module_name
from derive.kinematics.build import build
from tests.native.test_names import named
from tests.outside import written

PACKAGE = Path(softkin.__file__).parent
MODULES = {module for module, _ in softkin._CLASSES.values()}
NAMES = ("Catalogue", "Class", "Core", "Frame", "None", "Pose", "Status", "Try")
USED = """
import softkin
from softkin import Frame, Status, catalogue, core

for name, own in softkin.catalogue().items():
    assert getattr(softkin, own.__name__) is own, name
    robot = own(upper=300.0, lower=250.0)
    frame, configuration = robot.forward((20.0, 30.0, 5.0))
    assert type(frame) is Frame and issubclass(own, softkin.Mechanism)
    found = robot.inverse(frame, configuration, (0.0, 0.0, 0.0))
    assert max(abs(a - b) for a, b in zip(found, (20.0, 30.0, 5.0))) < 1e-9
assert (softkin.Frame, softkin.Status, softkin.catalogue, softkin.core) == (Frame, Status, catalogue, core)
print(len(catalogue()))
"""


def imported(path: Path) -> Iterator[str]:
    """The names that a module imports, but for classes of mechanisms."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and str(node.module).removeprefix("softkin.") not in MODULES:
            yield from (alias.asname or alias.name for alias in node.names)


def test_no_machine_has_a_name_of_the_package() -> None:
    """Neither what the package offers, nor what a module of a mechanism reads beside its class."""
    offered = {name for name in dir(softkin) if name not in {c for _, c in softkin._CLASSES.values()}}
    read = {name for module in MODULES for name in imported(PACKAGE / f"{module}.py")}
    beside = offered | {n for n in imported(PACKAGE / "__init__.py") if not n.startswith("_")}
    classes = sorted(n for n in offered | read if n[0].isupper() and n != n.upper())
    assert len(classes) > 30
    assert [n for n in classes if class_name(f"Kin_{n}", None) == n] == []
    assert [n for n in sorted(beside) if n.islower() and "__" not in n and module_name(f"Kin_{n}") == n] == []


@pytest.mark.slow
def test_both_can_be_had(tmp_path: Path) -> None:
    """A package of machines that are called so, and used."""
    written(package.files([package.part(build(named(name))) for name in NAMES]), tmp_path)
    command = [sys.executable, "-W", "error", "-c", USED]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.stdout.strip(), done.stderr) == (str(len(NAMES)), "")
