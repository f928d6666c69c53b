"""docs/COMPILER.md: every change that it shows is made in a copy of the source, and what comes of it works."""

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from shutil import copytree

import pytest

from tests.outside import output_of

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs/COMPILER.md").read_text(encoding="utf-8")
FILE = re.compile(r"`([\w/]+\.\w+)`\n\n```python\n(.*?)```\n", re.DOTALL)
CHANGE = re.compile(r"```diff\n(.*?)```\n", re.DOTALL)
LANGUAGE = "derive/emit/lua/"
TRIED = """
import sympy as sp
from derive.description.catalogue import MECHANISMS, load
from derive.emit.c.printer import C
from derive.emit.javascript.printer import PRINTER
from derive.emit.python.printer import ScalarPrinter
from derive.emit.st.expression import StructuredText
from derive.ir.primitives import CubeRoot
from derive.ir.symbols import real
from derive.pipeline import derive_one, files_of, languages
from derive.solver.subproblems.cubic import cubic
from tests.unit.solver.execution import answer, execute, problem
x, v, k = real("x"), real("v"), sp.Symbol("k", positive=True)
values, _ = execute(answer(cubic, problem(k * v**3 + x, lengths=(v,))).statements, {k: 2.0, x: 16.0})
assert abs(values["v"] + 2.0) < 1e-15
print(*(printer.print(CubeRoot(x)) for printer in (ScalarPrinter(), C(), PRINTER, StructuredText({"x": "x"}))))
built = derive_one(load(MECHANISMS / "softkin_swingrail.py"), wanted=["lua"])
print(built.measured, *(text.decode() for text in files_of([built], languages(wanted=["lua"])).values()))
"""


def hunks(change: str) -> Iterator[tuple[str, str, str]]:
    """Each changed place: its file, and its lines before and after."""
    for file in change.split("+++ ")[1:]:
        path, _, rest = file.partition("\n")
        for hunk in rest.split("@@\n"):
            lines = hunk.splitlines(keepends=True)
            yield path, *("".join(line[1:] for line in lines if line[0] in signs) for signs in (" -", " +"))


@pytest.fixture(scope="module")
def changed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the source in which everything is done that the page says."""
    copy = tmp_path_factory.mktemp("compiler")
    for folder in ("derive", "runtime", "templates", "tests/unit"):
        copytree(ROOT / folder, copy / folder, ignore=lambda _, names: [n for n in names if n == "__pycache__"])
    for path, text in FILE.findall(PAGE):
        (copy / path).parent.mkdir(exist_ok=True)
        assert not (copy / path).exists()
        (copy / path).write_text(text, encoding="utf-8")
    (copy / LANGUAGE / "__init__.py").write_text('"""Lua.\n\npackage: the files\n"""\n', encoding="utf-8")
    (copy / "pyproject.toml").write_text((ROOT / "pyproject.toml").read_text(encoding="utf-8"), encoding="utf-8")
    for path, before, after in (hunk for change in CHANGE.findall(PAGE) for hunk in hunks(change)):
        text = (copy / path).read_text(encoding="utf-8")
        assert text.count(before) == 1, (path, before)
        (copy / path).write_text(text.replace(before, after), encoding="utf-8")
    golden = copy / "tests/unit/passes/unanimous/alike.txt"
    golden.parent.mkdir()
    golden.write_text(
        "    if r > 1:\n        a = x\n    else:\n        a = x\n    return a\nbecomes\n", encoding="utf-8"
    )
    return copy


def run(folder: Path, *arguments: str) -> str:
    return output_of([sys.executable, *arguments], cwd=folder)


@pytest.mark.slow
def test_the_changes_work(changed: Path) -> None:
    """The tools are content, the pass has a golden file, the rule solves, and the rest is printed."""
    assert run(changed, "-m", "tests.unit.passes.test_golden") == ""
    golden = (changed / "tests/unit/passes/unanimous/alike.txt").read_text(encoding="utf-8")
    assert golden.endswith("becomes\n    a = x\n    return a\n")
    run(changed, "-m", "ruff", "check", "derive")
    run(changed, "-m", "ruff", "format", "--check", "derive")
    found = run(changed, "-c", TRIED)
    assert (
        "cube_root(x) softkin_cube_root(x) cubeRoot(x) Softkin_CubeRoot(x)" in found and "2 solutions  exact" in found
    )
    assert "local cos_a1 = math.cos(a1)" in found


def test_the_page_names_what_there_is() -> None:
    """Every file and folder that the page quotes is there, or is made on the page; it is no longer than it may be."""
    made = {path for path, _ in FILE.findall(PAGE)} | {"tests/unit/passes/unanimous/alike.txt"}
    quoted = set(re.findall(r"`((?:derive|docs|generated|runtime|templates|tests)/[\w/]*(?:\.\w+)?)`", PAGE)) - made
    missing = {path for path in quoted if not (ROOT / path).exists()}
    assert missing == {"runtime/st/softkin/Softkin_CubeRoot.st"} and len(PAGE.splitlines()) <= 250
