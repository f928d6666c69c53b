"""A mistake of the compiler is told as one: no remedy for the description, what to report, a status of its own."""

import re
from collections.abc import Callable

import pytest

import derive.description.catalogue as reading
from derive.faults import failure
from derive.ir.verify import BrokenProgram
from derive.kinematics import solution
from tests.command.files import RAIL, Folder

OF_THE_COMPILER = (
    r"^error: rail\.py: this is a mistake of the compiler, not of the description: {what} \({file}\.py:\d+\); "
    r"report it with softkin-compiler [\d.]+, Python [\d.]+, \w+, the file of the machine, and what --traceback prints$"
)
Break = Callable[..., object]


def undefined(*_: object) -> object:
    return frobnicate  # type: ignore[name-defined]  # noqa: F821


def broken(*_: object) -> object:
    raise BrokenProgram("forward: 'y' is read before it is bound")


def torn(*_: object) -> object:
    raise TypeError("loop of ufunc does not support it")


@pytest.fixture(params=[undefined, broken, torn], ids=lambda f: f.__name__)
def mistake(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Break:
    """A mistake inside the derivation; of the kinds that a description, too, may lead to, with remedies for it."""
    monkeypatch.setattr(solution, "solve_pose", request.param)
    return request.param


WHAT = {
    "undefined": "NameError: name 'frobnicate' is not defined",
    "broken": "BrokenProgram: forward: 'y' is read before it is bound",
    "torn": "TypeError: loop of ufunc does not support it",
}


@pytest.mark.parametrize("command", ["derive", "check"])
def test_a_mistake_says_what_to_report(folder: Folder, mistake: Break, command: str) -> None:
    folder.write("rail.py", RAIL)
    said = folder.run(command, "rail.py")
    assert said.status == 3
    assert re.match(OF_THE_COMPILER.format(what=WHAT[mistake.__name__], file="test_mistakes"), said.err)
    assert "define it above this line" not in said.err and "from sympy" not in said.err
    assert "Traceback" not in said.err and folder.names() == {"rail.py"}


def test_the_traceback_is_printed_where_it_is_asked_for(folder: Folder, mistake: Break) -> None:
    folder.write("rail.py", RAIL)
    said = folder.run("derive", "rail.py", "--traceback")
    assert said.status == 3 and "Traceback (most recent call last)" in said.err
    assert f"in {mistake.__name__}" in said.err and "in derive_and_measure" in said.err


def test_a_catalogue_with_a_mistake(folder: Folder, monkeypatch: pytest.MonkeyPatch) -> None:
    """From the process in which the machine is derived comes the message, and the traceback; the worst gives the
    status.
    """
    monkeypatch.setattr(solution, "solve_pose", undefined)
    folder.write("machines/rail.py", RAIL)
    folder.write("machines/wrong.py", RAIL.replace('"Rail"', '"Other"').replace("Ty(A2)", "Ty(A9)"))
    options = ("--mechanisms", "machines", "--output", "out", "--fresh", "--keep-going")
    said = folder.run("generate", *options, "--traceback")
    assert said.status == 3 and not folder.names("out")
    assert "wrong.py:9: NameError: name 'A9' is not defined; define it above this line" in said.err
    assert "rail.py: this is a mistake of the compiler" in said.err and "in derive_and_measure" in said.err


def test_one_mistake_stops_no_other_machine(folder: Folder, monkeypatch: pytest.MonkeyPatch) -> None:
    """A description that is wrong has status 2, the mistake 3: the worst is that of the run."""
    solve = solution.solve_pose
    monkeypatch.setattr(solution, "solve_pose", lambda m: undefined() if m.name == "Other" else solve(m))
    folder.write("machines/a.py", RAIL.replace("Ty(A2)", "Ty(A9)"))
    folder.write("machines/b.py", RAIL.replace('"Rail"', '"Other"'))
    folder.write("machines/c.py", RAIL)
    said = folder.run("check", "machines")
    assert said.status == 3 and "1 of 3 derived, 2 refused" in said.out
    assert "a.py:9: NameError: name 'A9' is not defined; define it above this line" in said.err
    assert "b.py: this is a mistake of the compiler" in said.err
    folder.write("machines/b.py", RAIL)
    assert folder.run("check", "machines").status == 2


def test_a_mistake_while_a_description_is_read(folder: Folder, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a check of the compiler, not in the file: its last frame tells."""
    folder.write("rail.py", RAIL)
    monkeypatch.delitem(vars(reading), "validate")  # the name that `load` calls is not defined
    said = folder.run("check", "rail.py")
    assert said.status == 3 and "define it above" not in said.err
    assert re.match(
        OF_THE_COMPILER.format(what="NameError: name 'validate' is not defined", file="catalogue"), said.err
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("from derive.mechanism import rotatory\n", "rail.py:1: ImportError: cannot import name 'rotatory'"),
        ("import no_such_module\n", "rail.py:1: ModuleNotFoundError: No module named 'no_such_module'"),
        ("from own_lengths import L1\n", "rail.py:1: NameError: name 'length' is not defined; write above it: from"),
    ],
)
def test_a_file_that_lacks_a_name_is_at_fault(
    folder: Folder, monkeypatch: pytest.MonkeyPatch, text: str, said: str
) -> None:
    """Also where what it imports is a file of the user's own."""
    monkeypatch.syspath_prepend(folder.path)
    folder.write("own_lengths.py", 'L1 = length("link_1", "first link", nominal=300.0)\n')
    folder.write("rail.py", text + RAIL)
    answer = folder.run("check", "rail.py")
    assert answer.status == 2 and said in answer.err and "mistake of the compiler" not in answer.err


def test_a_mistake_of_a_command(folder: Folder, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no machine is under way the sentence names no file."""
    monkeypatch.setattr("derive.command.new.description", undefined)
    said = folder.run("new", "rail.py")
    assert said.status == 3 and said.err.startswith("error: this is a mistake of the compiler, not of the descr")


def test_what_the_system_refuses_is_nobodys_mistake() -> None:
    assert failure(None, MemoryError()).message == "MemoryError"
    assert failure(None, OSError("no space left")) == failure(None, OSError("no  space left"))
    assert not failure(None, OSError("no space left")).trace


def test_a_drawing_gives_no_remedy_for_a_mistake(folder: Folder, monkeypatch: pytest.MonkeyPatch) -> None:
    """The formulas are proven without it: a warning, of which the description is not the cause."""
    monkeypatch.setattr("derive.emit.softmotion.pictures.pictures_of", torn)
    folder.write("rail.py", RAIL)
    said = folder.run("check", "rail.py")
    assert said.status == 0 and "not drawn: TypeError: loop of ufunc does not support it\n" in said.out
