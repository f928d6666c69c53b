"""The wheel of the compiler: what `setup.py` puts into it is enough to derive machines, far from the source tree."""

import runpy
import shutil
import sys
import tomllib
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from derive.emit.language import files_in
from tests.command.files import RAIL, ROOT
from tests.outside import output_of


def packages(include: list[str]) -> list[str]:
    """The packages that `setuptools.find_packages` finds: folders with a module `__init__`, below one another."""
    assert include == ["derive*"]
    inits = sorted((ROOT / "derive").rglob("__init__.py"))
    return [".".join(p.parent.relative_to(ROOT).parts) for p in inits if "__pycache__" not in p.parts]


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with what the wheels of the compiler and of the catalogue hold."""
    given: dict[str, Any] = {}
    stub = ModuleType("setuptools")
    vars(stub).update(setup=given.update, find_packages=packages)
    monkeypatch.setitem(sys.modules, "setuptools", stub)
    monkeypatch.chdir(ROOT)
    runpy.run_path(str(ROOT / "setup.py"))
    site = tmp_path / "site"
    for package in given["packages"]:
        source, target = (
            ROOT / given["package_dir"].get(package, package.replace(".", "/")),
            site / Path(*package.split(".")),
        )
        target.mkdir(parents=True)
        data = [p for pattern in given["package_data"].get(package, []) for p in source.glob(pattern)]
        for path in (*source.glob("*.py"), *(p for p in data if p.is_file())):
            (target / path.relative_to(source)).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, target / path.relative_to(source))
    catalogue = ROOT / "generated/python"
    stated = tomllib.loads((catalogue / "pyproject.toml").read_text())["tool"]["setuptools"]
    for package in stated["packages"]:
        folder = Path(*package.split("."))
        (site / folder).mkdir()
        for pattern in ("*.py", *stated["package-data"].get(package, ())):
            for path in (catalogue / folder).glob(pattern):
                shutil.copy(path, site / folder / path.name)
    return site


def run(installed: Path, folder: Path, program: str) -> None:
    """Run a program in a folder, with what is installed in front of all else."""
    command = [sys.executable, "-c", f"import sys; sys.path[0] = {str(installed)!r}\n{program}"]
    output_of(command, cwd=folder, env={})


@pytest.mark.slow
def test_what_is_installed_derives_a_machine(installed: Path, tmp_path: Path) -> None:
    """No file of the source tree is read: templates and runtime come with the compiler; nor is one of them missing."""
    for name in ("templates", "runtime"):
        assert {p.relative_to(ROOT / name) for p in files_in(ROOT / name)} <= {
            p.relative_to(installed / "derive" / name) for p in files_in(installed / "derive" / name)
        }
    (tmp_path / "rail.py").write_text(RAIL)
    run(installed, tmp_path, RUN)
    assert (tmp_path / "build/st/own/Rail.st").is_file() and (tmp_path / "build/python/rail/_core.py").is_file()


RUN = """
import builtins, derive
from pathlib import Path
from derive.command.line import main
assert main(["derive", "rail.py"]) == 0
from derive.cache import foundation
from derive.command.catalogue import OUTPUT
assert foundation(None) and OUTPUT == Path("generated"), OUTPUT
strange = [m.__file__ for n, m in sys.modules.items() if n.split(".")[0] == "derive" and sys.path[0] not in m.__file__]
assert not strange, strange
"""


NOTEBOOK = """
import softkin
from derive import compile_mechanism
Rail = compile_mechanism("rail.py")
assert issubclass(Rail, softkin.Mechanism) and softkin.__file__.startswith(sys.path[0]) and softkin.catalogue()
assert Rail().forward((1.0, 2.0))[0].position == (1.0, 2.0, 0.0)
"""


@pytest.mark.slow
def test_a_notebook_beside_both_wheels(installed: Path, tmp_path: Path) -> None:
    """No wheel has the files that only build it; a live class needs the modules of the runtime alone."""
    (tmp_path / "rail.py").write_text(RAIL)
    run(installed, tmp_path, NOTEBOOK)


def test_the_command_is_that_of_the_module() -> None:
    """The console script of the distribution is the function that `python -m derive` calls."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    module, _, function = project["scripts"]["softkin"].partition(":")
    assert getattr(import_module(module), function) is import_module("derive.__main__").run
