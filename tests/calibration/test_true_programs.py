"""Machines derived with deviations as inputs, in four languages, against their chains and `robot.calibrated`."""

from dataclasses import dataclass, replace
from functools import cache
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import softkin
import sympy as sp

from derive.command.line import main
from derive.description.catalogue import MECHANISMS
from derive.description.mechanism import DescriptionError, Mechanism
from derive.form.deviations import with_deviations
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.measured.pose import true_pose
from derive.witness import witness
from tests.calibration.machines import Planted, Truth, drawn_axes, planted
from tests.calibration.test_true_machine import EXACT, apart, lost
from tests.languages.language import LANGUAGES, Language
from tests.machines.made import built_of, imported_class
from tests.mechanisms import catalogue, kinematics_of, named
from tests.text.controller import OK, Controller
from tests.text.units import compiled_text

pytestmark = pytest.mark.slow
NAMES = ("Kin_ArticulatedRobot_6DOF", "Kin_Scara4_ZCcoupled_Type1", "Softkin_TableTable_AC")
EVERY = pytest.mark.parametrize("name", NAMES)
WITHOUT = {"Kin_Ac6_RZRYRYRXRYRZ_J6Offset": "searched for roots"}
WITHOUT |= {m.name: "moved by loops" for _, m in catalogue() if m.drives}
"""Serial machines of the catalogue that have no such programs, and why."""


@dataclass(frozen=True)
class Both:
    """A machine with planted deviations: derived with them as inputs, and as the runtime calibrates it."""

    planted: Planted
    nominal: softkin.Mechanism
    """The derived one without deviations."""
    text: str
    """Its block."""

    @property
    def true(self) -> softkin.Mechanism:
        """The derived one as it is."""
        return self.nominal.calibrated(self.planted.deviations)

    def poses(self, count: int) -> list[tuple[float, ...]]:
        """Random axis values."""
        return drawn_axes(self.nominal, count, np.random.default_rng(3))


@cache
def described(name: str) -> Mechanism:
    """The description with deviations, under a name of its own: the package has the drawing, too."""
    return replace(with_deviations(named(name)), name=f"Kin_True_{name.split('_', 1)[1]}", class_name=None)


@cache
def both(name: str) -> Both:
    """The machine with deviations of 5 mrad and 5 mm in all that it has."""
    mechanism, machine = described(name), planted(name, np.random.default_rng(7))
    built = built_of(mechanism)
    return Both(machine, imported_class(mechanism, built)(**machine.given), built.parts["st"]["text"])


@EVERY
def test_forward_is_the_chain_and_inverse_meets_it(name: str) -> None:
    """The frame is that of the chain; every slot that answers meets it on its branch, and none is lost."""
    machine, true = both(name), both(name).true
    truth, commanded = Truth(name, machine.planted.given, machine.planted.deviations), 0
    for axes in machine.poses(20):
        frame, configuration = true.forward(axes)
        wrong = frame.matrix - truth.forward(axes)
        assert np.abs(wrong[:3, :3]).max() < EXACT and np.abs(wrong[:3, 3]).max() < 1000.0 * EXACT
        for solution in true.inverse_all(frame, axes):
            if solution.axes is not None:
                commanded += 1
                there, own = true.forward(solution.axes)
                assert apart(true, there, frame) < EXACT
                size = true.BRANCHES
                assert all(a in (b, 3) for a, b in zip(own[:size], solution.configuration[:size], strict=True))
        assert configuration is not None
    assert commanded > 20
    assert not lost(true, machine.poses(50))


@EVERY
def test_without_deviations_it_is_the_drawing_to_the_last_bit(name: str) -> None:
    """Frames, branches, axes, Jacobian, and what is out of reach."""
    nominal, drawn = both(name).nominal, both(name).planted.nominal
    for axes in both(name).poses(60):
        frame, configuration = drawn.forward(axes)
        own, other = nominal.forward(axes)
        assert own.position == frame.position and own.rotation == frame.rotation and other == configuration
        assert nominal.inverse(own, configuration) == drawn.inverse(frame, configuration)
        assert np.array_equal(nominal.jacobian(axes), drawn.jacobian(axes))
        far = (tuple(3.0 * p for p in frame.position), frame.rotation)
        assert [s.axes for s in nominal.inverse_all(far, axes)] == [s.axes for s in drawn.inverse_all(far, axes)]


@EVERY
def test_it_is_the_machine_that_the_runtime_calibrates(name: str) -> None:
    """Names, units and signs are the same, and one JSON is for both; so are frames, and the solutions of all slots."""
    machine = both(name)
    true, other = machine.true, machine.planted.true
    assert true.deviations == other.deviations and list(true.deviations) == list(other.deviations)
    assert type(true) is type(machine.nominal) and type(true).from_dict(true.to_dict()) == true
    assert true.calibrated({"tool_x": 0.0}).deviations["tool_x"] == 0.0
    solutions, same = 0, 0
    for axes in machine.poses(20):
        frame = true.forward(axes)[0]
        assert apart(true, frame, other.forward(axes)[0]) < EXACT
        for own, its in zip(true.inverse_all(frame, axes), other.inverse_all(frame, axes), strict=True):
            assert (own.axes is None) is (its.axes is None)
            if own.axes is not None and its.axes is not None:
                solutions += 1
                same += bool(np.abs(np.subtract(own.axes, its.axes)).max() < 1e-6)
    assert same >= 0.97 * solutions > 0  # next to folds a branch of the true machine may have two solutions


@pytest.mark.parametrize("language", LANGUAGES, ids=str)
@pytest.mark.parametrize("name", NAMES[:2])
def test_languages_answer_as_python(language: Language, name: str) -> None:
    """Forward and inverse kinematics in C and in JavaScript."""
    machine, true = both(name), both(name).true
    poses = machine.poses(25)
    frames = [true.forward(axes) for axes in poses]
    plain = [{"position": list(f.position), "rotation": [list(r) for r in f.rotation]} for f, _ in frames]
    calls = [["forward", list(axes)] for axes in poses]
    calls += [["inverse", frame, list(c), list(axes)] for axes, frame, (_, c) in zip(poses, plain, frames, strict=True)]
    given = {"parameters": {**machine.planted.given, **machine.planted.deviations}, "calls": calls}
    (answer,) = language.ask(language.of(described(name)), [given])
    for found, (frame, _) in zip(answer["found"], frames, strict=False):
        assert np.allclose(found["frame"]["position"], frame.position, rtol=0.0, atol=1e-9)
    for found, axes, (frame, c) in zip(answer["found"][len(poses) :], poses, frames, strict=True):
        assert found["axes"] == pytest.approx(true.inverse(frame, c, axes), abs=1e-8)


@pytest.mark.parametrize("name", NAMES[:2])
def test_structured_text_answers_as_python(name: str) -> None:
    """The block with the deviations as inputs, executed."""
    machine, true = both(name), both(name).true
    controller = Controller(compiled_text(f"{name}.st", machine.text), described(name))
    assert controller.initialise(true.parameters) == OK
    for axes in machine.poses(8):
        frame, configuration = true.forward(axes)
        status, (position, rows, _) = controller.forward(axes)
        assert status == OK and position == pytest.approx(frame.position, abs=1e-9)
        status, found = controller.inverse(position, rows, configuration, axes)
        assert status == OK
        assert found[: len(axes)] == pytest.approx(true.inverse(frame, configuration, axes), abs=1e-8)


@pytest.mark.parametrize("name", [m.name for _, m in catalogue() if m.chain is not None and m.task.position])
def test_every_serial_machine_of_the_catalogue(name: str) -> None:
    """Its programs are those of its true chain, and no solution is missing: the witness measures them."""
    if name in WITHOUT:
        with pytest.raises(DescriptionError, match=WITHOUT[name]):
            kinematics_of(described(name))
        return
    kinematics: Kinematics = kinematics_of(described(name))
    found = witness(kinematics, described(name)).inverted
    assert found is not None and found.solutions >= 1
    longest = max(sp.count_ops(let.value) for let in true_pose(kinematics.mechanism).statements)
    assert longest < 1000, "a frame has no names, so that each further one is longer"


def test_what_has_no_lines_is_refused() -> None:
    """A closed loop has dimensions."""
    with pytest.raises(DescriptionError, match="the deviations of a closed loop are those of its dimensions"):
        with_deviations(named("Kin_Delta_P3C_Type3"))


def test_the_command_derives_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`softkin derive --calibrated`."""
    source = MECHANISMS / "kin_gantry3.py"
    assert main(["derive", str(source), "--calibrated", "--out", str(tmp_path), "--language", "linuxcnc"]) == 0
    (module,) = (tmp_path / "linuxcnc").glob("*.c")
    assert "x-tilt-y" in module.read_text()
    assert main(["derive", str(source), "--out", str(tmp_path), "--language", "linuxcnc"]) == 0
    assert "x-tilt-y" not in module.read_text() and capsys.readouterr().err == ""


def test_one_json_is_for_both(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A machine that the catalogue calibrates, loaded by a package that was derived with its deviations."""
    options = ["--calibrated", "--package", "true_gantry", "--language", "python", "--out", str(tmp_path)]
    assert main(["derive", str(MECHANISMS / "kin_gantry3.py"), *options]) == 0
    monkeypatch.syspath_prepend(str(tmp_path / "python"))
    path = tmp_path / "true.json"
    machine = softkin.Gantry3().calibrated({"x_tilt_y": 0.1, "y_offset": 2.0})
    path.write_text(machine.to_json())
    loaded = import_module("true_gantry").load(path)
    assert loaded.parameters["x_tilt_y"] == 0.1 and loaded.deviations == machine.deviations
    assert loaded.forward((1.0, 2.0, 3.0))[0].position == pytest.approx(machine.forward((1.0, 2.0, 3.0))[0].position)
