"""What is written, and its calls with the types of a machine: width, includes, use, and the runtime file by file."""

import re
import subprocess
from contextlib import suppress
from pathlib import Path

import pytest
import softkin

from derive.emit.c import package, printer
from derive.emit.c.printer import is_reserved, member, spelled
from derive.emit.language import RUNTIME
from derive.ir.constants import LEAST
from tests.c.machine import described
from tests.c.programs import COMPILER, SANITIZED, STRICT, compile_in, files_of, part_of, program_of, written
from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.recording import read
from tests.mechanisms import kinematics_of, named
from tests.native.build import SOURCES, headers
from tests.outside import output_of

ROOT = Path(__file__).parents[2]
SHARED = {"softkin.c", "softkin.h", "softkin_constants.h", "softkin_rotation.h"}
HEADERS = {"<math.h>", "<stdbool.h>", "<stddef.h>", "<stdint.h>", *(f'"{name}"' for name in SHARED)}


@pytest.mark.broad
@pytest.mark.parametrize("name", DIMENSIONS)
def test_lines_and_includes(name: str) -> None:
    """No line is wider than a page; nothing is allocated, changed globally, or included besides libm."""
    part = part_of(name)
    for path, text in files_of(part).items():
        wide = [line for line in text.splitlines() if len(line) > 110]
        assert not wide, (path, wide[0])
        assert "\t" not in text and text.endswith("\n") and " \n" not in text
        assert set(re.findall(r"^#include (.*)$", text, re.MULTILINE)) <= {*HEADERS, f'"{part["index"]["module"]}.h"'}
        code = re.sub(r"/\*.*?\*/|\"(\\.|[^\"])*\"", "", text, flags=re.DOTALL)
        assert not re.search(r"\b(malloc|calloc|alloca|printf|goto|errno|volatile|rand|time|//)\b", code), path
        changed = [line for line in re.findall(r"^(?:static )?[a-z].*(?:=|;)$", code, re.MULTILINE)
                   if "(" not in line and not line.startswith(("typedef", "static const", "const", "extern const"))
                   and not line.endswith("}")]  # fmt: skip
        assert not changed, (path, changed)


@pytest.mark.broad
@pytest.mark.parametrize("name", DIMENSIONS)
def test_the_description_is_that_of_the_class(name: str) -> None:
    """Axes, parameters, bytes, rows, margins: what the class of the package says."""
    told, made = described(program_of(name)), softkin.catalogue()[name]
    assert told.name == name
    assert [(a["name"], a["kind"], a["unit"], a["meaning"], bool(a["multi_turn"])) for a in told.axes] == [
        (a.name, a.kind, a.unit, a.meaning, a.multi_turn) for a in made.AXES
    ]
    assert [(p["name"], p["kind"], p["unit"], p["meaning"]) for p in told.parameters] == [
        (p.name, p.kind, p.unit, p.meaning) for p in made.PARAMETERS
    ]
    for one, other in zip(told.parameters, made.PARAMETERS, strict=True):
        low = max(other.low, float(LEAST)) if other.low_is_open else -1.0 if other.kind == "sign" else other.low
        assert (one["low"], one["high"], bool(one["low_is_open"])) == (low, min(other.high, 1e9), other.low_is_open)
        assert other.default is None and one["default"] != one["default"] or one["default"] == other.default
    assert [(name, first, second, initial) for name, first, second, initial in told.configuration] == [
        (b.name, *(b.branches or ("", "")), b.default) for b in made.CONFIGURATION
    ]
    assert told.margins == tuple(made.MARGINS) and told.rows == tuple(made.JACOBIAN_ROWS)
    assert told.branches == made.BRANCHES


def test_names() -> None:
    """The files that all share have names that no machine takes."""
    assert package.module_name("Kin_Softkin") == "softkin_machine"
    assert package.module_name("Kin_Math") == "math_machine"  # a folder with another math.h
    assert package.module_name("Kin_Lanes") == "lanes_machine"  # the core of the Python package has such a file
    assert package.module_name("Kin_3RRR") == "kin_3rrr"
    assert package.module_name("Kin_Numbers") == "numbers"


@pytest.mark.parametrize("name", ["double", "NAN", "__FILE__", "M_PI", "linux", "softkin_root", "_Bool", "while"])
def test_words_are_no_names(name: str) -> None:
    """A name with another meaning is neither a variable nor a member; any other is both."""
    assert is_reserved(name) and not is_reserved(spelled(name)) and not is_reserved(member(name))
    assert spelled("reach") == member("reach") == "reach" and member("ends") != "ends" and spelled("k") != "k"
    assert printer.text('a "b" ??/ c') == r'"a \"b\" ?\?/ c"'


@pytest.mark.parametrize("value", [1.0, -0.5, 1e9, -1e12, 2500000.0, 1e-11, 1e22, 1.5e300, 123456789.0, 0.1, 5e-324])
def test_literals(value: float) -> None:
    """A literal is a real number, and the one that is meant."""
    text = printer.number(value)
    assert float(text) == value and ("." in text or "e" in text)


def test_a_machine_that_does_not_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    """The arrays of the calls have an end: no source is written that would write beyond it."""
    kinematics = kinematics_of(named("Kin_Scara4_ZCcoupled_Type1"))
    for most, size in (("MOST_AXES", 3), ("MOST_BRANCHES", 0)):
        with monkeypatch.context() as changed:
            changed.setattr(package, most, size)
            assert package.part(kinematics) is None
    assert package.part(kinematics) is not None


def test_the_program_of_the_guide() -> None:
    """It compiles as docs/C.md says, and prints what the page says."""
    text = (ROOT / "docs/C.md").read_text(encoding="utf-8")
    program = re.search(r"```c\n(.*?)```", text, re.DOTALL)
    printed = re.search(r"    cc -std=c99 (.*)\n    (.*)\n", text)
    assert program and printed
    folder = written({**files_of(part_of("Kin_Scara4_ZCcoupled_Type1")), "main.c": program[1]})
    sources = printed[1].partition(" && ")[0].split()
    compile_in(folder, *sources)
    assert output_of([folder / "a.out"]) == f"{printed[2]}\n"


@pytest.mark.slow
def test_optimised_and_for_cpp() -> None:
    """No warning where the compiler looks deeper; C++ reads the headers (that of the search is the longest source)."""
    parts = [part_of(name) for name in ("Kin_Scara4_ZCcoupled_Type1", "Kin_Ac6_RZRYRYRXRYRZ_J6Offset")]
    folder = written(package.files(parts))
    compile_in(folder, "-O2", "-Wpedantic", "-c", *(path.name for path in folder.glob("*.c")))
    (folder / "all.cpp").write_text("".join(f'#include "{part["index"]["module"]}.h"\n' for part in parts))
    options = [option for option in STRICT if not option.startswith("-std")]
    subprocess.run([COMPILER, *options, "-std=c++11", "-fsyntax-only", "all.cpp"], cwd=folder, check=True)


FOLDERS = (RUNTIME / "c", RUNTIME / "native")


FILES = [path for folder in FOLDERS for path in sorted(folder.glob("*.[ch]"))]
EXTENSIONS = [path for path in FILES if "Python.h" in path.read_text(encoding="utf-8")]
"""They need the headers of Python, as the core itself does: `python -m tests.native` says where there are none."""
ASKED = FILES if Path(headers(), "Python.h").is_file() else [path for path in FILES if path not in EXTENSIONS]


@pytest.mark.parametrize("path", ASKED, ids=str)
def test_it_compiles_alone(path: Path) -> None:
    """No warning, and no name that another file would have to bring."""
    folders = [f"-I{folder}" for folder in (*FOLDERS, SOURCES, headers())]
    subprocess.run([COMPILER, *STRICT, *folders, "-fsyntax-only", "-x", "c", path], check=True)


TYPED = Path(__file__).with_name("typed.c")


@pytest.mark.slow("Kin_Ac6")
@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("Kin_Scara4_ZCcoupled_Type1", ()),
        ("Softkin_Planar_3RRR", ("-DSTARTS",)),
        ("Kin_Ac6_RZRYRYRXRYRZ_J6Offset", ("-DSEARCHED",)),
    ],
)
def test_typed_calls(name: str, options: tuple[str, ...]) -> None:
    """They answer the same, also where a frame or a reference is an argument and the place of the result."""
    part = part_of(name)
    module = part["index"]["module"]
    folder = written(files_of(part))
    options = (*options, f"-DMODULE={module}", f'-DHEADER="{module}.h"', f"-DPOSE={_possible(name)}", "-I.")
    compile_in(folder, *SANITIZED, *options, str(TYPED), f"{module}.c", "softkin.c", "-lm")
    output_of([folder / "a.out"])


def _possible(name: str) -> str:
    """Axis values with which the machine of nominal dimensions can stand."""
    made = softkin.catalogue()[name]
    robot = made(**{p.name: p.nominal for p in named(name).parameters if p.fixed is None})
    asked = [question for part in read(name) for question in part["asked"]]
    for question in (q for q in asked if q["call"] == "forward" and q["kind"] == "regular"):
        with suppress(softkin.KinematicsError):
            frame, configuration = robot.forward(question["axes"])
            if robot.inverse(frame, configuration, question["axes"]):
                return ",".join(map(repr, question["axes"]))
    raise LookupError(name)
