"""The import script, run in a stand-in for the ScriptEngine: a library with every object, checked by a compiler."""

import ast
import contextlib
import io
import re
import runpy
import shutil
import sys
import tokenize
from collections.abc import Callable
from pathlib import Path

import pytest

from derive.command.catalogue import OUTPUT
from derive.emit.st.contract import load
from tests.codesys.parts import FILES, all_parts
from tests.codesys.scriptengine_stand_in import (
    Code,
    Dut,
    Engine,
    Folder,
    LibraryManager,
    Message,
    Node,
    Project,
    Property,
    Severity,
)

# The nodes of Python 2.7's grammar by the names they have today.
_NODES = set(
    """
    Module FunctionDef ClassDef Return Delete Assign AugAssign For While If With Raise Try ExceptHandler Assert Import
    ImportFrom alias Global Expr Pass Break Continue BoolOp And Or BinOp Add Sub Mult Div Mod Pow LShift RShift BitOr
    BitXor BitAnd FloorDiv UnaryOp Invert Not UAdd USub Lambda IfExp Dict Set ListComp SetComp DictComp GeneratorExp
    comprehension Yield Compare Eq NotEq Lt LtE Gt GtE Is IsNot In NotIn Call keyword Constant Attribute Subscript Name
    List Tuple Load Store Del Slice arguments arg withitem
    """.split()
)
_NEWER_FIELDS = ("returns", "annotation", "cause", "kwonlyargs", "posonlyargs", "type_params", "is_async")


def beyond_python27(source: str) -> list[str]:
    """The places, with lines, that Python 2.7 would refuse or read differently; none for a source that is both."""
    tree = ast.parse(source)
    found = [_problem(node) for node in ast.walk(tree)]
    found += [
        f"line {t.start[0]}: {t.string}" for t in _tokens(source) if t.type == tokenize.NUMBER and "_" in t.string
    ]
    if not source.isascii() and "coding" not in "".join(source.split("\n")[:2]):
        found.append("letters that are not ASCII, without a line that says the coding")
    if not _imports_print(tree):
        found += [f"line {n.lineno}: print without its future import" for n in ast.walk(tree) if _is_call(n, "print")]
    return [problem for problem in found if problem]


def _problem(node: ast.AST) -> str:
    name, line = type(node).__name__, getattr(node, "lineno", 0)
    if name not in _NODES:
        return f"line {line}: {name}"
    newer = [field for field in _NEWER_FIELDS if getattr(node, field, None)]
    if isinstance(node, ast.ClassDef) and node.keywords:
        newer.append("keywords")
    if isinstance(node, ast.Dict) and None in node.keys:
        newer.append("unpacking")
    if isinstance(node, ast.Call) and _is_call(node, "super") and not node.args:
        newer.append("super without arguments")
    return f"line {line}: {name} with {', '.join(newer)}" if newer else ""


def _tokens(source: str) -> list[tokenize.TokenInfo]:
    return list(tokenize.generate_tokens(io.StringIO(source).readline))


def _imports_print(tree: ast.Module) -> bool:
    futures = [n for n in tree.body if isinstance(n, ast.ImportFrom) and n.module == "__future__"]
    return any(a.name == "print_function" for n in futures for a in n.names)


def _is_call(node: ast.AST, name: str) -> bool:
    return isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == name


SOURCE = OUTPUT / "st"
SCRIPT = SOURCE / "import_softkin.py"
TITLES = ("SM3_Transformation", "SM3_Math", "SM3_Error")


def execute(engine: Engine, *arguments: str, script: Path = SCRIPT) -> int:
    """Run the script as CODESYS does, not imported, with the module in place; the exit code."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "scriptengine", engine)
        patch.setattr(sys, "argv", [str(script), *arguments])
        try:
            runpy.run_path(str(script))
        except SystemExit as end:
            return int(end.code or 0)
        return 0


@pytest.fixture(scope="module")
def imported(tmp_path_factory: pytest.TempPathFactory) -> tuple[Project, str]:
    """The project that the script makes of everything, and what it prints."""
    engine, target = Engine(TITLES), tmp_path_factory.mktemp("codesys") / "Softkin.library"
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        assert execute(engine, str(target)) == 0
    (project,) = engine.made
    return project, printed.getvalue()


@pytest.mark.slow
def test_a_library_with_every_object(imported: tuple[Project, str]) -> None:
    project, printed = imported
    assert project.is_saved and Path(project.path).exists()
    assert vars(project.information) == {"title": "Softkin", "company": "Softkin", "version": "0.1.0.0"}
    assert _panes(project.get_children(True)) == {
        (part.kind, path): (part.declaration, part.implementation) for (_, path), part in all_parts(FILES).items()
    }
    assert printed.count("\n") == 2, "one message of the compiler, and the summary"
    assert "Build: Severity.Information: C32 Compile complete (Softkin)" in printed
    made = f"{len(all_parts(FILES))} objects and {len(project.external_files)} pictures"
    assert f"{made} in {project.path}; errors of the compiler: 0" in printed


@pytest.mark.slow
def test_descriptions_find_their_pictures(imported: tuple[Project, str]) -> None:
    project, _ = imported
    referred = [name for text in FILES.values() for name in re.findall(r"^\.\. image:: @\((.+)\)$", text, re.MULTILINE)]
    assert sorted(referred) == sorted(project.external_files)
    assert all(data == (SOURCE / "pictures" / name).read_bytes() for name, data in project.external_files.items())


def _panes(nodes: list[Node]) -> dict[tuple[str, str], tuple[str, str]]:
    kinds = {
        "FunctionBlock": "FUNCTION_BLOCK", "Function": "FUNCTION", "Enumeration": "TYPE", "Structure": "TYPE",
        "Get": "GET", "Program": "PROGRAM",
    }  # fmt: skip
    found = {}
    for node in nodes:
        if isinstance(node, Dut):
            path, parent = node.get_name(), node.parent
            while isinstance(parent, Node) and not isinstance(parent, Folder):
                path = parent.get_name() if isinstance(parent, Property) else f"{parent.get_name()}.{path}"
                path = path if not isinstance(parent, Property) else parent.get_name()
                parent = parent.parent
            declared = "" if node.kind == "Get" else node.textual_declaration.text
            code = node.textual_implementation.text if isinstance(node, Code) else ""
            found[kinds.get(node.kind, node.kind), path] = (declared, code)
    return found


@pytest.mark.slow
def test_references_are_placeholders_for_the_newest_library(imported: tuple[Project, str]) -> None:
    (manager,) = (one for one in imported[0].get_children() if isinstance(one, LibraryManager))
    assert {t: (one.title, one.version) for t, one in manager.placeholders.items()} == {
        t: (t, (4, 20, 0, 0)) for t in TITLES
    }


@pytest.mark.slow
def test_folders_by_family(imported: tuple[Project, str]) -> None:
    """The objects of the library are in folders by family of mechanisms."""
    (top,) = (one for one in imported[0].get_children() if isinstance(one, Folder))
    assert top.get_name() == "Softkin"
    inside = {folder.get_name(): {one.get_name() for one in folder.get_children()} for folder in top.get_children()}
    assert set(inside) == {name.split("/")[0] for name in FILES}
    assert {"Softkin_Scara2_Z", "Softkin_Scara2_Z_Config", "Softkin_Scara2_Z_ReadConfig"} <= inside["scara"]
    assert "Softkin_MatrixOrder" in inside["softkin"]


def _copy(tmp_path: Path, old: str = "", new: str = "") -> Path:
    """The script with one block and what it shares; in the block a text is replaced."""
    shutil.copytree(SOURCE / "softkin", tmp_path / "softkin")
    shutil.copy(SCRIPT, tmp_path)
    (tmp_path / "scara").mkdir()
    text = FILES["scara/Softkin_Scara2_Z.st"]
    assert old in text
    (tmp_path / "scara" / "Softkin_Scara2_Z.st").write_text(
        text.replace(old, new, 1) if old else text, encoding="utf-8"
    )
    return tmp_path / SCRIPT.name


def test_what_does_not_compile_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script = _copy(tmp_path, "refusal := '';", "initialised := '';")
    engine = Engine(TITLES)
    assert execute(engine, str(tmp_path / "a.library"), script=script) == 1
    printed = capsys.readouterr().out
    assert "Severity.Error" in printed and "initialised" in printed
    assert "errors of the compiler: 1" in printed
    assert engine.made[0].is_saved, "to be looked at"


def _advice(engine: Engine, tmp_path: Path, error: Message, capsys: pytest.CaptureFixture[str]) -> str:
    """What the script prints below an error of the compiler."""
    engine.further = [error]
    assert execute(engine, str(tmp_path / "a.library"), script=_copy(tmp_path)) == 1
    lines = capsys.readouterr().out.splitlines()
    return lines[1 + next(i for i, line in enumerate(lines) if error.text in line)].strip()


@pytest.mark.parametrize(
    ("case", "text", "place"),
    [
        ("constant", "'SMC_TRAFO_NOT_INITIALIZED' ist nicht definiert", "Softkin_Names"),
        ("method", "no 'CartesianToAxes' of interface 'MC_KIN_REF_SM3'", "Softkin_Scara2_Z"),
        ("own", "unknown type '__SYSTEM.IQueryInterface'", "ISoftkin"),
        ("own", "no such interface", "ISoftkin"),
        ("interface", "unknown type 'ISMKinematicWithConfigurations4'", "Softkin_Kinematics"),
        ("other", "unknown type 'UDINT'", "AxesToCartesian"),
    ],
)
def test_it_says_what_to_do(
    case: str, text: str, place: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    error = Message(Severity.Error, text, Dut(place, "TYPE"))
    assert _advice(Engine(TITLES), tmp_path, error, capsys) == load().spelling["messages"][case]["do"]


def test_the_guide_says_the_same() -> None:
    """Every paragraph of section 10 on the compiler has the title and the first words that the script has."""
    guide = (OUTPUT.parent / "docs" / "CODESYS.md").read_text(encoding="utf-8")
    _, section = guide.split("\n## 10. When it does not compile, or refuses\n")
    compiling = section.split("\n**Initialize refuses.**")[0]
    found = [" ".join(one.split()) for one in compiling.split("\n\n") if one.startswith("**")]
    expected = [f"**{one['case']}** {one['do']} " for one in load().spelling["messages"].values()]
    assert len(found) == len(expected)
    assert all(paragraph.startswith(begin) for paragraph, begin in zip(found, expected, strict=True))


def test_a_dialog_asks_for_the_path(tmp_path: Path) -> None:
    target = tmp_path / "asked.library"
    assert execute(Engine(TITLES, str(target)), script=_copy(tmp_path)) == 0
    assert target.exists()


def _with_open_project() -> Engine:
    engine = Engine(TITLES)
    engine.projects.primary = object()
    return engine


REFUSALS: dict[str, tuple[Callable[[], Engine], tuple[str, ...], str]] = {
    "a project is open": (_with_open_project, ("{}/a.library",), "a project is open: save and close it first"),
    "no path": (lambda: Engine(TITLES), (), "no library was named"),
    "a cancelled dialog": (lambda: Engine(TITLES, ""), (), "no library was named"),
    "no library": (lambda: Engine(TITLES), ("{}/a.project",), "must end with .library"),
    "an existing file": (lambda: Engine(TITLES), ("{}/there.library",), "exists: choose another path"),
    "no SoftMotion": (lambda: Engine(()), ("{}/a.library",), "the library SM3_Transformation is not installed"),
}


@pytest.mark.parametrize("case", REFUSALS)
def test_refusals_are_one_line(case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A wrong argument or environment is refused with one line, before a library is made."""
    engine, arguments, message = REFUSALS[case]
    (tmp_path / "there.library").touch()
    assert execute(engine(), *(a.format(tmp_path) for a in arguments)) == 1
    printed = capsys.readouterr().out
    assert printed.startswith("error: ") and message in printed and printed.count("\n") == 1
    assert not (tmp_path / "a.library").exists()


def test_away_from_its_files_it_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A copy of the script without the files beside it says what is missing."""
    script = tmp_path / SCRIPT.name
    shutil.copy(SCRIPT, script)
    assert execute(Engine(TITLES), str(tmp_path / "a.library"), script=script) == 1
    assert "leave it in the folder in which it came" in capsys.readouterr().out


def test_it_is_python_2_7() -> None:
    assert beyond_python27(SCRIPT.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    "newer",
    [
        "f'{a}'", "def f(a: int): pass", "def f() -> int: pass", "def f(*, a): pass", "a: int = 1", "raise A from b",
        "(a := 1)", "def f():\n  yield from a", "async def f(): pass", "a @ b", "f(*a, *b)", "[*a]", "{**a}", "1_000",
        "class A(B, metaclass=C): pass", "def f():\n  nonlocal a", "def f(a, /): pass", "a, *b = c", "print(1, end='')",
        "super().a()", "match a:\n  case 1: pass", "a = 'é'",
    ],
)  # fmt: skip
def test_what_is_newer_is_seen(newer: str) -> None:
    assert beyond_python27(newer) != []
