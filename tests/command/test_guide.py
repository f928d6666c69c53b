"""The guide for authors: its machines are derived and used, its walk is walked, its refusals are those that come."""

import importlib
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields

import numpy as np
import pytest
import softkin
from sympy import lambdify

from derive import mechanism as vocabulary
from derive.command.line import main
from derive.description.catalogue import load
from derive.description.mechanism import Mechanism
from derive.ir.symbols import POSITION, ROTATION_ENTRIES
from tests.catalogue.closure import Closure
from tests.catalogue.driven_machines import DrivenClosure
from tests.command.files import Folder, python
from tests.command.guide import COMMANDS, MACHINES, PROGRAMS, REFUSALS, TEXT, pattern
from tests.command.wrong import WRONG

pytestmark = pytest.mark.slow

SOLUTIONS = {
    "arm_on_track": 2, "loader": 2, "palletizer": 4, "five_bar": 4, "trunnion": 2, "planar_3rrr": 6, "hung_camera": 1,
}  # fmt: skip
SAID_ELSEWHERE = {
    "… must not be 0: parallel slides": "a machine says it, when it is set up: tests/machines",
    "the margins … do not multiply to the determinant of the Jacobian; state the joints and lengths": (
        "tests/unit/kinematics/test_refusals"
    ),
    "… was given up after … steps": "tests/unit/witness/test_refusals",
    "the search misses … of … solutions; leave search= out": "tests/unit/witness/test_refusals",
    "the home pose has … assembly modes": "tests/unit/witness/test_refusals",
    "… holds '…', which was not generated: it is not replaced": "test_derive",
    "… holds '…' of another machine: take another folder, or remove it": "test_derive",
    "… holds '…', written by another version of Softkin: take another folder, or remove it": "test_derive",
    "… holds the machine '…': derive into another folder with --out, or remove it": "test_derive",
    "'…' is a package that exists: give another name with --package": "test_derive",
    "'…' cannot name a Python package: give another one with --package": "test_derive",
    "there is no such file; `softkin new": "test_derive",
}
CLOSED = 1e-8


def test_every_refusal_of_the_guide_has_a_test() -> None:
    assert len(set(REFUSALS)) == len(REFUSALS) >= 50
    assert set(REFUSALS) == set(WRONG) | set(SAID_ELSEWHERE)


@pytest.mark.parametrize("refusal", WRONG)
def test_it_is_refused_as_the_guide_says(folder: Folder, refusal: str) -> None:
    """One line: file, line, what is wrong, what to do. Status 2, and nothing is written."""
    folder.write("wrong.py", WRONG[refusal])
    said = folder.run("derive", "wrong.py", "--out", "build")
    assert said.status == 2
    assert said.err.count("\n") == 1, said.err
    assert re.match(rf"error: wrong\.py:\d+: {pattern(refusal)}", said.err), said.err
    assert folder.names() == {"wrong.py"}


LINES = {
    "chain reads '…', which is not a joint or a parameter of this mechanism; list it": "    chain=",
    "joint '…' occurs nowhere in the closure; use it": "E1 = linear(",
    "parameter '…': its nominal value … is outside its range …": "L1 = length(",
    "joint '…' is given 2 times; give each thing a name of its own": "A2 = rotary(",
    "branch '…': its indicator agrees with 0 steps, not one: …softkin explain…": "    branches=",
    "'…' cannot name a family": '    name="ArmOnTrack", family=',
    "the closure does not determine …": "MECHANISM = Mechanism(name=",
    "branch '…' needs two names with the signs +1 and -1": "    branches=",
    "SyntaxError: …": "MECHANISM = Mechanism((",
    "assembly '…': the loop can be assembled in one way alone: leave it out": "    assembly=",
}


@pytest.mark.parametrize("refusal", LINES)
def test_the_line_is_that_of_the_fault(folder: Folder, refusal: str) -> None:
    folder.write("wrong.py", WRONG[refusal])
    number = int(re.match(r"error: wrong\.py:(\d+):", folder.run("check", "wrong.py").err)[1])  # type: ignore[index]
    assert WRONG[refusal].splitlines()[number - 1].startswith(LINES[refusal])


@pytest.mark.parametrize("name", MACHINES)
def test_the_machine_is_derived_and_every_solution_closes(
    folder: Folder, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Package, block and picture are written; every solution on every branch closes the description."""
    path = folder.write(f"{name}.py", MACHINES[name])
    said = folder.run("derive", f"{name}.py")
    assert (said.status, said.err) == (0, "") and "warning" not in said.out
    assert f" {SOLUTIONS[name]} solution" in said.out, "those that the machine is known to have"
    machine = load(path)
    block = machine.block_name
    assert {f"st/own/{block}.st", f"st/pictures/{block}.png", f"python/{name}/__init__.py"} <= folder.names("build")
    monkeypatch.syspath_prepend(str(folder.path / "build/python"))
    (robot_class,) = importlib.import_module(name).catalogue().values()
    assert _solutions_that_close(machine, robot_class(**{p.name: p.nominal for p in machine.parameters})) >= 12


def _solutions_that_close(machine: Mechanism, robot: softkin.Mechanism) -> int:
    """How many solutions there are at twelve poses; each of them closes, and one is where the pose came from."""
    start, size = np.array([j.nominal for j in machine.joints]), 25.0
    if machine.home:
        start, size = np.array(robot.inverse(((0.0, 0.0, 0.0), np.eye(3).tolist()), (1, 1, 1, 0, 0, 0))), 8.0
    sizes = np.where([j.is_angle for j in machine.joints], size, 100.0)
    found, residual = 0, _residual(machine, robot.parameters)
    loose = type(robot)(**{**robot.parameters, "max_miss": 1e9}) if robot.SURPLUS else robot
    for axes in start + np.random.default_rng(3).uniform(-1.0, 1.0, (12, len(start))) * sizes:
        frame, configuration = loose.forward(axes)
        if robot.SURPLUS:  # their lengths follow from the pose of the others
            axes[list(robot.SURPLUS)] += list(robot.misses(axes).values())
        assert np.allclose(robot.inverse(frame, configuration, axes), axes, rtol=0.0, atol=1e-7)
        solved = [solution.axes for solution in robot.inverse_all(frame, axes) if solution.axes is not None]
        assert max(residual(one, frame) for one in solved) <= CLOSED
        found += len(solved)
    return found


def _residual(machine: Mechanism, given: Mapping[str, float]) -> Callable[[Sequence[float], softkin.Frame], float]:
    """The largest error of the closure in lengths: of the chain, or of the length of a rod."""
    if machine.chain is not None:
        closure = DrivenClosure(machine, given, 2000.0) if machine.drives else Closure(machine, given)

        def of_chain(axes: Sequence[float], frame: softkin.Frame) -> float:
            row = closure.joints(np.array([axes]))
            return float(np.abs(closure.equations(row, np.array([frame.position]), np.array([frame.rotation]))).max())

        return of_chain
    lengths = {p.symbol: given[p.name] for p in machine.parameters}
    names = [*POSITION, *ROTATION_ENTRIES]
    spans = [rod.equation + rod.length**2 for rod in machine.rods]
    squares = lambdify([*(j.symbol for j in machine.joints), *names], [span.subs(lengths) for span in spans])
    stated = lambdify([j.symbol for j in machine.joints], [rod.length.subs(lengths) for rod in machine.rods])
    units = np.array([np.radians(1.0) if j.in_degrees else 1.0 for j in machine.joints])

    def of_rods(axes: Sequence[float], frame: softkin.Frame) -> float:
        pose = [*frame.position, *(v for line in frame.rotation for v in line)]
        joints = units * axes
        return float(np.abs(np.sqrt(squares(*joints, *pose)) - stated(*joints)).max())

    return of_rods


def test_the_walk(folder: Folder) -> None:
    """The commands of the guide, in their order, and the path that is plotted at the end."""
    assert [c for c in COMMANDS if not c.startswith("pip")] == [
        "softkin new machines/my_machine.py",
        "softkin check machines/my_machine.py",
        "softkin explain machines/my_machine.py",
        "softkin derive machines/my_machine.py --out build",
    ]
    for command in COMMANDS:
        program, *arguments = command.split()
        assert program == "softkin" and main(arguments) == 0 or program == "pip"
    plot = "import matplotlib; matplotlib.use('Agg')\n" + PROGRAMS["plot_path"]
    python(plot, folder.path, folder.path / "build/python")  # as a script here finds its packages
    assert (folder.path / "path.png").stat().st_size > 5000


def test_the_guide_names_what_there_is() -> None:
    """Every field of a mechanism, and every way to make a parameter, stands in the guide."""
    told = set(re.findall(r"\w+", TEXT))
    assert {f.name for f in fields(Mechanism)} - {"bounds", "class_name"} <= told
    for word in ("length", "signed_length", "optional_length", "distance", "coordinate", "angle", "pitch", "gear"):
        assert word in told and hasattr(vocabulary, word)
