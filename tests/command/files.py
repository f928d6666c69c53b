"""A folder of a user: description files, and commands that run in it."""

import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from derive.command.line import main
from derive.command.new import description
from tests.outside import output_of

ROOT = Path(__file__).resolve().parents[2]
RAIL = '''\
"""A slide on a slide: the smallest machine that can be derived."""

from derive.frames import Tx, Ty
from derive.mechanism import Mechanism, Task, linear

A1 = linear("A1", "Slide along X")
A2 = linear("A2", "Slide along Y")

MECHANISM = Mechanism(name="Rail", joints=(A1, A2), chain=Tx(A1) * Ty(A2), task=Task("xy"))
'''
SCARA = description("scara.py", "MyScara")


@dataclass(frozen=True)
class Said:
    status: int
    out: str
    err: str


@dataclass(frozen=True)
class Folder:
    path: Path
    capsys: pytest.CaptureFixture[str]

    def write(self, name: str, text: str) -> Path:
        path = self.path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def run(self, *arguments: object) -> Said:
        status = main([str(a) for a in arguments])
        said = self.capsys.readouterr()
        return Said(status, said.out, said.err)

    def names(self, below: str = ".") -> set[str]:
        """The paths of all files below a folder of it."""
        start = self.path / below
        return {str(p.relative_to(start)) for p in start.rglob("*") if p.is_file()}


def python(code: str, *paths: Path) -> str:
    """What a program prints that finds packages in these folders, and NumPy, alone."""
    numpy = Path(pytest.importorskip("numpy").__file__).parents[1]
    script = f"import sys; sys.path[:0] = {[str(p) for p in paths]!r}; sys.path.append({str(numpy)!r})\n{code}"
    return output_of([sys.executable, "-I", "-S", "-c", script])
