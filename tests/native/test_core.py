"""Which core runs: as the environment says, or native where there is one; a wrong choice is an error that says so."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import softkin

from tests.native.build import EXTENSION, FOLDER, ROOT
from tests.native.machines import NAMES, native

PACKAGE = ROOT / "generated" / "python"
OLD = "SOURCES, MACHINES = 'other', ()\n"
"""An extension of another generation."""


def imported(choice: str | None, *folders: Path, code: str = "import softkin; print(softkin.core)") -> tuple[str, str]:
    """What an import says, on standard output and in the last line of the errors."""
    path = os.pathsep.join(map(str, (PACKAGE, *folders)))
    given = {"PYTHONPATH": path} | ({} if choice is None else {"SOFTKIN_CORE": choice})
    done = subprocess.run([sys.executable, "-c", code], env=given, capture_output=True, text=True, check=False)
    return done.stdout.strip(), (done.stderr.strip().splitlines() or [""])[-1]


def test_the_tests_run_on_it() -> None:
    """It is this core that is asked here, and it has every machine."""
    assert softkin.core == "native"
    assert {name for name, cls in softkin.catalogue().items() if cls._is_native} == set(softkin.catalogue())


@pytest.mark.parametrize("name", NAMES)
def test_every_machine_is_made(name: str) -> None:
    """The constants that C computes are accepted by it."""
    assert native(name)._machine.answers


def test_the_environment_chooses() -> None:
    """Native where there is an extension, unless Python is asked for."""
    assert imported(None, FOLDER) == ("native", "")
    assert imported("native", FOLDER) == ("native", "")
    assert imported("python", FOLDER) == ("python", "")
    assert imported(None) == ("python", "")
    assert imported("", FOLDER) == ("native", "")


def test_a_wrong_choice_is_an_error() -> None:
    """A word that means nothing, and a native core that is not there."""
    assert imported("fast", FOLDER) == ("", "ImportError: SOFTKIN_CORE must be python or native, not 'fast'")
    out, said = imported("native")
    assert out == "" and said.startswith(
        f"ImportError: SOFTKIN_CORE is native, but the extension {EXTENSION} is not installed"
    )


def test_an_extension_of_other_sources_is_not_used(tmp_path: Path) -> None:
    """It would compute with another layout of its arguments: it is left alone, and refused where it is asked for."""
    (tmp_path / f"{EXTENSION}.py").write_text(OLD)
    assert imported(None, tmp_path) == ("python", "")
    out, said = imported("native", tmp_path)
    assert out == "" and said.startswith("ImportError: SOFTKIN_CORE is native") and "other sources" in said


def test_a_class_with_another_text_is_pythons(tmp_path: Path) -> None:
    """A machine whose formulas the extension does not have runs in Python, though its module has a known name."""
    code = (
        "import softkin, softkin._native as n; k = softkin.Crane.KEY; n._KNOWN = n._KNOWN - {k};"
        "cls = type('Crane2', (softkin.Mechanism,), {**{a: v for a, v in vars(softkin.Crane).items()"
        " if not a.startswith('__') and a not in softkin.Crane.__slots__}, 'KEY': 'crane 0'});"
        "print(softkin.Crane._is_native, cls._is_native)"
    )
    assert imported(None, FOLDER, code=code) == ("True False", "")


def test_the_import_stays_light() -> None:
    """NumPy is loaded with the first batch, and not by the extension."""
    code = "import sys, softkin; softkin.Crane(); print('numpy' in sys.modules, softkin.core)"
    assert imported(None, FOLDER, code=code) == ("False native", "")
