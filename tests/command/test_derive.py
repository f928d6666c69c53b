"""`softkin derive`, `check` and `new`: one file in, a package and a block out; no file stands in the way of another."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.command.files import RAIL, ROOT, SCARA, Folder, python
from tests.command.wrong import changed

USED = """
import my_scara, softkin
robot = my_scara.MyScara(link_length_1=325.0, link_length_2=225.0)
axes = (10.0, 20.0, 5.0, 30.0)
frame, configuration = robot.forward(axes)
assert configuration == (1, 1, 1, 1)
other = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, pitch_zc=0.0)
assert "numpy" not in sys.modules
assert all(abs(a - b) < 1e-12 for a, b in zip(frame.position, other.forward(axes)[0].position))
assert all(abs(a - b) < 1e-9 for a, b in zip(axes, robot.inverse(frame, configuration, axes)))
assert len(robot.inverse_all(frame)) == 2
slots, statuses = robot.inverse_all_batch([frame.position], [frame.rotation])
assert statuses.tolist() == [[0, 0]] or statuses.shape == (1, 2)
assert robot.singularity(axes).margins and robot.jacobian(axes)
assert not isinstance(robot, softkin.Mechanism), "a package of its own"
strange = {n.split(".")[0] for n in sys.modules} & {"derive", "sympy", "casadi", "jinja2", "matplotlib"}
assert not strange, strange
assert not [n for n in my_scara.catalogue() if n != "MyScara"]
print(my_scara.__file__)
"""


CARDAN = """
from sympy import Matrix
from derive.mechanism import ROTATION, Mechanism, Task, Turning, guide, length, linear, rod

SIZE = length("size", "Centre to the end of a pushrod", nominal=100.0)
S1, S2 = (linear(f"S{k}", f"Length of pushrod {k}", nominal=200.0) for k in (1, 2))
ENDS = [tuple(ROTATION * Matrix(end)) for end in ((SIZE, 0, 0), (0, SIZE, 0))]
MECHANISM = Mechanism(
    name="Mirror", joints=(S1, S2), parameters=(SIZE,), task=Task("", Turning.DIRECTION), home=(0, 0, 0),
    rods=(rod("1", (SIZE, 0, -200), ENDS[0], S1), rod("2", (0, SIZE, -200), ENDS[1], S2)),
    guides=(guide("cardan", (0, 1, 0), ENDS[0]),), positive=(S1, S2),
)
"""


@pytest.fixture
def scara(folder: Folder) -> Folder:
    """A folder in which a SCARA has been derived."""
    folder.write("my_scara.py", SCARA)
    said = folder.run("derive", "my_scara.py", "--out", "build")
    assert (said.status, said.err) == (0, "")
    stages = [line.split()[0] for line in said.out.splitlines()[2:]]
    assert stages == ["derive", "measure", "draw", "write", "picture:", "next:"], said.out
    assert "picture: build/st/pictures/MyScara.png" in said.out
    assert "next: pip install build/python, then import my_scara in Python; not beside my_scara.py" in said.out
    assert "144 poses" in said.out and "2 solutions" in said.out
    return folder


def test_one_command_gives_everything_that_a_user_of_the_machine_needs(scara: Folder) -> None:
    """Package, block, XML, picture, self-test; headers say what was measured; and the package works alone."""
    names = scara.names("build")
    assert {
        "python/LICENSE", "python/pyproject.toml", "python/README.md", "python/my_scara/__init__.py",
        "python/my_scara/myscara.py", "python/my_scara/py.typed", "st/own/MyScara.st", "st/own/MyScara.xml",
        "st/softkin.xml", "st/pictures/MyScara.png", "st/pictures/MyScara.svg", "st/selftest/MyScara_SelfTest.st",
        "st/import_softkin.py", "st/samples/MyScara.st", "st/samples/MyScara.xml",
    } <= names  # fmt: skip
    assert not [n for n in names if "softkin/" in n and n.startswith("python")]
    class_text = (scara.path / "build/python/my_scara/myscara.py").read_text()
    assert "Verified at 144 poses" in class_text and "softkin" not in class_text
    assert "residual" in (scara.path / "build/st/own/MyScara.st").read_text()
    readme = (scara.path / "build/python/README.md").read_text()
    example = "\n".join(re.findall(r"^    (.*)$", readme, re.MULTILINE))
    assert "my_scara.MyScara(link_length_1=325.0, link_length_2=225.0)" in example
    python(example, scara.path / "build/python")
    project = tomllib.loads((scara.path / "build/python/pyproject.toml").read_text())
    assert (project["project"]["name"], project["project"]["dependencies"]) == ("my-scara", ["numpy>=1.26"])
    folders = {str(Path(n).parent).replace("/", ".") for n in scara.names("build/python") if n.endswith("__init__.py")}
    assert set(project["tool"]["setuptools"]["packages"]) == folders
    found = python(USED, scara.path / "build/python", ROOT / "generated/python")
    assert found.strip() == str(scara.path / "build/python/my_scara/__init__.py")


@pytest.mark.slow
def test_deriving_again_changes_nothing_and_another_machine_does_not_replace_it(scara: Folder) -> None:
    """The folder of one machine is never that of another one, nor that of other files."""
    before = {n: (scara.path / "build" / n).read_bytes() for n in scara.names("build")}
    assert scara.run("derive", "my_scara.py", "--out", "build").status == 0
    assert before == {n: (scara.path / "build" / n).read_bytes() for n in scara.names("build")}
    scara.write("rail.py", RAIL)
    said = scara.run("derive", "rail.py", "--out", "build")
    assert said.status == 2
    assert "build holds the machine 'my_scara': derive into another folder with --out, or remove it" in said.err
    said = scara.run("derive", "rail.py", "--out", ".")
    assert said.status == 2 and "which was not generated: it is not replaced" in said.err
    assert before == {n: (scara.path / "build" / n).read_bytes() for n in scara.names("build")}


def test_what_other_commands_write_into_the_same_folder_stays(folder: Folder) -> None:
    """`explain --html`, `view`, another language, and pip: all of them write into build, in any order."""
    folder.write("rail.py", RAIL)
    others = (
        "report/Rail.html",
        "rail.html",
        "javascript/rail.js",
        "br/rail.c",
        "fmu/rail.fmu",
        "lib/derive/a.py",
        "bdist.linux-x86_64/a",
    )
    for name in others:
        folder.write(f"build/{name}", "kept")
    for _ in range(2):
        assert folder.run("derive", "rail.py", "--out", "build").status == 0
        assert {n.split("/")[0] for n in folder.names("build")} == {"python", "st", *(n.split("/")[0] for n in others)}
    folder.write("build/mine.txt", "mine")
    said = folder.run("derive", "rail.py", "--out", "build")
    assert said.status == 2 and "build holds 'mine.txt', which was not generated: it is not replaced" in said.err


def test_machines_stand_beside_each_other_where_they_share_no_list(folder: Folder) -> None:
    """C of two machines is in one folder, if its shared sources are of one version; a list is of one machine."""
    folder.write("rail.py", RAIL)
    folder.write("other.py", RAIL.replace('"Rail"', '"Other"'))
    into = ("--out", "build", "--language")
    for path in ("rail.py", "other.py"):
        assert folder.run("derive", path, *into, "c").status == 0
    assert {"rail.c", "other.c", "softkin.h"} <= folder.names("build/c")
    folder.write("build/c/mine.txt", "mine")
    folder.write("build/c/softkin.h", "/* Generated by `make generate`: of yesterday. */")
    said = folder.run("derive", "rail.py", *into, "c")
    assert said.status == 2 and "build/c holds 'mine.txt', written by another version of Softkin" in said.err
    assert folder.run("derive", "rail.py", *into, "javascript").status == 0
    said = folder.run("derive", "other.py", *into, "javascript")
    assert said.status == 2
    assert "build/javascript holds 'rail.js' of another machine: take another folder, or remove it" in said.err


def test_one_wrong_file_stops_no_other(folder: Folder) -> None:
    """Of many machines each has a folder of its own; what is wrong is said, and the rest is written."""
    folder.write("machines/a_rail.py", RAIL)
    folder.write("machines/b_wrong.py", RAIL.replace("Ty(A2)", "Ty(A1)"))
    folder.write("machines/c_worse.py", "raise SystemExit(0)\n")
    folder.write("machines/d_rail.py", RAIL.replace('"Rail"', '"Other"'))
    said = folder.run("derive", "machines", "--out", "out")
    assert said.status == 2
    first, second = (line for line in said.err.splitlines() if line.startswith("error:"))  # others: what takes long
    assert re.match(r"error: machines/b_wrong\.py:\d+: joint 'A2' occurs nowhere in the closure; use it in", first)
    assert re.match(r"error: machines/c_worse\.py:1: the description ends the program; let the file define", second)
    assert {n.split("/")[0] for n in folder.names("out")} == {"a_rail", "d_rail"}
    assert "2 of 4 derived, 2 refused" in said.out
    said = folder.run("derive", "machines", "--out", "other", "--no-keep-going")
    assert said.status == 2 and said.err.count("error:") == 1
    assert {n.split("/")[0] for n in folder.names("other")} == {"a_rail"}


def test_check_writes_nothing(folder: Folder) -> None:
    """`check` derives and measures; the folder is as it was."""
    folder.write("rail.py", RAIL)
    before = folder.names()
    said = folder.run("check", "rail.py")
    assert said.status == 0 and "144 poses" in said.out and "files, not written" in said.out
    assert folder.names() == before


@pytest.mark.parametrize(
    ("file", "more", "package"),
    [("My-Machine.py", (), "my_machine"), ("2r.py", (), "machine_2r"), ("rail.py", ("--package", "Robot7"), "Robot7")],
)
def test_the_package_is_called_after_the_file(folder: Folder, file: str, more: tuple[str, ...], package: str) -> None:
    folder.write(file, RAIL)
    assert folder.run("derive", file, *more).status == 0
    used = f"import {package}; print({package}.Rail().forward((1.0, 2.0))[0].position)"
    assert python(used, folder.path / "build/python").strip() == "(1.0, 2.0, 0.0)"


@pytest.mark.parametrize(
    ("file", "more", "message"),
    [
        ("random.py", (), "'random' is a package that exists: give another name with --package"),
        ("softkin.py", (), "'softkin' is a package that exists"),
        ("class.py", (), "'class' cannot name a Python package: give another one with --package"),
        ("rail.py", ("--package", "my robot"), "'my robot' cannot name a Python package"),
        ("rail.py", ("--profile", "of_1990"), "of_1990"),
    ],
)
def test_a_package_that_would_hide_another_is_refused(
    folder: Folder, file: str, more: tuple[str, ...], message: str
) -> None:
    folder.write(file, RAIL)
    said = folder.run("derive", file, *more)
    assert said.status == 2 and message in said.err and said.err.count("\n") == 1
    assert folder.names() == {file}


def test_files_that_would_be_written_into_one_folder_are_refused(folder: Folder) -> None:
    for place in ("one", "two"):
        folder.write(f"{place}/rail.py", RAIL)
    said = folder.run("derive", "one/rail.py", "two/rail.py")
    assert said.status == 2 and "2 files would be written into build/rail: give them different names" in said.err
    said = folder.run("derive", "one/rail.py", "two/rail.py", "--package", "rail")
    assert said.status == 2 and "--package names the package of one machine" in said.err


def test_new_writes_a_description_that_can_be_derived(folder: Folder) -> None:
    """What `new` writes is a machine that checks, and it never replaces a file."""
    assert folder.run("new", "arms/two_links.py").status == 0
    assert folder.run("check", "arms/two_links.py").status == 0
    text = (folder.path / "arms/two_links.py").read_text()
    assert 'name="TwoLinks"' in text and "softkin derive two_links.py" in text
    said = folder.run("new", "arms/two_links.py")
    assert said.status == 2 and "is there already" in said.err
    assert (folder.path / "arms/two_links.py").read_text() == text


def test_new_writes_a_five_axis_machine(folder: Folder) -> None:
    """Of any order, inclined and with errors if that is asked; words that say more of it do not stand alone."""
    words = ("--nutating", "--location-errors", "--tool-vector")
    assert folder.run("new", "--five-axis", "HeadTable_BA", *words, "my_mill.py").status == 0
    text = (folder.path / "my_mill.py").read_text()
    assert 'five_axes("MyMill", head="B", table="A", nutating=True, location_errors=True, tool_vector=True)' in text
    said = folder.run("check", "my_mill.py")
    assert (said.status, said.err) == (0, "") and "2 solutions  exact" in said.out
    said = folder.run("new", "--nutating", "other.py")
    assert said.status == 2 and "and --tool-vector say more of --five-axis ORDER: add it" in said.err
    assert not (folder.path / "other.py").exists()


@pytest.mark.parametrize(("first", "second"), [(0.325, 0.225), (3250.0, 2250.0)])
def test_lengths_may_be_numbers_of_any_unit(folder: Folder, first: float, second: float) -> None:
    """A machine without parameters is measured over its own size, in metres as in millimetres."""
    text = changed(
        SCARA,
        ("parameters=(L1, L2, HEIGHT),", ""),
        ("Tx(L1) *", f"Tx({first}) *"),
        ("Tx(L2) * Tz(HEIGHT + A3)", f"Tx({second}) * Tz(A3)"),
    )
    folder.write("scara.py", text)
    said = folder.run("check", "scara.py")
    assert (said.status, said.err) == (0, "") and "2 solutions" in said.out


def test_an_output_that_cannot_be_written_is_told(folder: Folder) -> None:
    folder.write("rail.py", RAIL)
    folder.write("taken", "a file")
    said = folder.run("derive", "rail.py", "--out", "taken")
    assert said.status == 2 and said.err.startswith("error: ") and said.err.count("\n") == 1
    assert (folder.path / "taken").read_text() == "a file"


def test_a_missing_file_and_an_empty_folder(folder: Folder) -> None:
    (folder.path / "empty").mkdir()
    said = folder.run("derive", "nothing.py")
    assert said.status == 2 and "nothing.py: there is no such file; `softkin new nothing.py` writes one" in said.err
    said = folder.run("check", "empty")
    assert said.status == 2 and "there is no description in this folder" in said.err
    folder.write("table.txt", "")
    said = folder.run("check", "table.txt")
    assert said.status == 2 and "not a Python file: a description is a file whose name ends in .py" in said.err


def test_the_command_as_a_program_ends_with_status_2_and_without_a_traceback(folder: Folder) -> None:
    path = folder.write("broken.py", RAIL.replace("Ty(A2)", "Ty(A9)"))
    done = subprocess.run(
        [sys.executable, "-m", "derive", "derive", str(path)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert (done.returncode, "Traceback" in done.stderr) == (2, False)
    assert re.search(r"broken\.py:9: NameError: name 'A9' is not defined; define it above this line", done.stderr)


def test_generate_keeps_going_where_it_is_asked_to(folder: Folder) -> None:
    """The catalogue is written whole or not at all, but for `--keep-going`; every file that is wrong is named."""
    folder.write("machines/a_rail.py", RAIL)
    folder.write("machines/b_wrong.py", RAIL.replace("Ty(A2)", "Ty(A1)"))
    folder.write("machines/c_wrong.py", RAIL.replace('"Rail"', '"Other"').replace("Ty(A2)", "Tx(A2)"))
    options = ("--mechanisms", "machines", "--output", "out", "--fresh")
    said = folder.run("generate", *options)
    assert said.status == 1 and said.err.count("error: ") == 1 and not folder.names("out")
    said = folder.run("generate", *options, "--keep-going")
    assert said.status == 1 and said.err.count("error: ") == 2
    assert re.search(r"c_wrong\.py:9: the closure does not determine a1, a2: ", said.err)
    assert "st/own/Rail.st" in folder.names("out")


def test_what_only_turns_commands_a_direction_alone(folder: Folder) -> None:
    folder.write("mirror.py", CARDAN)
    said = folder.run("check", "mirror.py")
    assert said.status == 0 and "Mirror: axes S1 S2; commanded: a direction\n" in said.out


def test_the_makefile_says_the_same() -> None:
    """`make generate MECHANISM=… OUT=…` is `softkin derive … --out …`; also where make itself runs the tests."""
    given = {n: v for n, v in os.environ.items() if n not in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "FRESH", "PROFILE")}
    command = ["make", "--no-print-directory", "-n", "generate", "MECHANISM=my_machine.py", "OUT=there"]
    for words, end in ((command, "-m derive derive my_machine.py --out there"), (command[:4], "-m derive generate")):
        done = subprocess.run(words, cwd=ROOT, env=given, capture_output=True, text=True, check=False)
        assert done.stdout.splitlines()[-1].rstrip().endswith(end)
