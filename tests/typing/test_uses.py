"""A file of uses is clean under mypy and pyright, strict both, and runs; mistakes are found."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.outside import output_of

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parents[1] / "generated/python"
MYPY = ("mypy", "--strict", "--no-error-summary", "--cache-dir", str(HERE.parents[1] / ".mypy_cache"))
"""With what the checks of the style have read already: NumPy and the package."""
SETTINGS = {
    "include": [str(HERE / "uses.py"), str(HERE / "wrong.py")],
    "extraPaths": [str(PACKAGE)],
    "typeCheckingMode": "strict",
    "pythonVersion": "3.11",
}


def said(*command: str, **more: str) -> str:
    environment = {**os.environ, **more}
    done = subprocess.run(
        [sys.executable, "-m", *command], cwd=HERE, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode in (0, 1), done.stdout + done.stderr
    return done.stdout


def by_mypy(_: Path) -> set[tuple[str, int]]:
    """The file and the line of every error of mypy."""
    text = said(*MYPY, "uses.py", "wrong.py", MYPYPATH=str(PACKAGE))
    return {(name, int(line)) for name, line in re.findall(r"^(\w+\.py):(\d+): error", text, re.MULTILINE)}


def by_pyright(folder: Path) -> set[tuple[str, int]]:
    """The file and the line of every error of pyright."""
    settings = folder / "pyrightconfig.json"
    settings.write_text(json.dumps(SETTINGS))
    text = said("basedpyright", "--outputjson", "--project", str(settings))
    found = json.loads(text)["generalDiagnostics"]
    return {(Path(one["file"]).name, one["range"]["start"]["line"] + 1) for one in found if one["severity"] == "error"}


@pytest.mark.slow("by_pyright")
@pytest.mark.parametrize("checker", [by_mypy, by_pyright])
def test_strict_checkers(checker: object, tmp_path: Path) -> None:
    """No error in the uses, one on every line with a mistake."""
    lines = (HERE / "wrong.py").read_text(encoding="utf-8").splitlines()
    expected = {("wrong.py", number) for number, line in enumerate(lines, 1) if line.endswith("# mistake")}
    assert len(expected) == 6
    assert checker(tmp_path) == expected  # type: ignore[operator]


def test_the_uses_run() -> None:
    """What type checkers accept works."""
    output_of([sys.executable, HERE / "uses.py"], env={"PYTHONPATH": str(PACKAGE)})
