"""The sample projects: valid, and executed on stand-ins: the moves, the panel, and the picture at random axes."""

import json
import re
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest
import softkin
from numpy.typing import NDArray

from derive.command.catalogue import OUTPUT
from derive.description.mechanism import Mechanism
from derive.drawing.drawing import scene_at
from derive.drawing.pose import nominal_machine, pose_at
from derive.drawing.scene import Body
from derive.emit.softmotion.library import StructuredTextFiles
from derive.kinematics.sampling import sample_axes
from derive.report.reference_calls import Machine
from tests.codesys.guide import library_of as compiled
from tests.codesys.parts import SAMPLES, parts_of
from tests.codesys.plcopen_reader import identifiers, listed, parse, wholes
from tests.codesys.test_axis_group import ROBOTICS, SMC_ERROR_OF_THE_GROUP
from tests.codesys.test_plcopen import errors
from tests.harness.library import Library
from tests.mechanisms import catalogue, kinematics_of

MECHANISMS = {m.block_name: m for _, m in catalogue() if m.block_name in SAMPLES}
EXACT = 1e-5
"""The reference rounds lengths to six decimals."""


def test_there_is_one_of_each_kind() -> None:
    """An arm in a plane, a loop in space, and an arm with six axes."""
    found = {(len(mechanism.joints), mechanism.chain is None) for mechanism in MECHANISMS.values()}
    assert found == {(3, False), (4, True), (6, False)} and len(SAMPLES) == 3


@pytest.mark.parametrize("name", SAMPLES)
def test_its_file_is_valid_and_has_the_same_text(name: str) -> None:
    """The file has the objects of the text, and no others: the block comes from its own file, or from the library."""
    path = OUTPUT / "st" / "samples" / f"{name}.xml"
    assert errors(path.read_text(encoding="utf-8")) == []
    read = {(p.kind, p.path): p for whole in wholes(parse(path)).values() for p in (whole.own, *whole.members)}
    assert read == {(p.kind, p.path): p for p in parts_of(SAMPLES[name])}
    assert [p for _, p in read] == [
        f"{name}_Drawing", f"{name}_Drawing.Draw", "SamplePoint", "PRG_Picture", "PRG_Demo", "PRG_Jog",
    ]  # fmt: skip
    assert identifiers(parse(path)) == listed(parse(path))


def drives_of(name: str) -> list[str]:
    return [f"Drive_{joint.name}" for joint in MECHANISMS[name].joints]


def library_of(name: str, old: str = "", new: str = "") -> Library:
    """The programs of a sample with its block, on stand-ins; in the sample a text is replaced."""
    text = SAMPLES[name]
    assert old in text
    declared = ["  Machine : AXIS_GROUP_REF_SM3;", *(f"  {drive} : AXIS_REF_SM3;" for drive in drives_of(name))]
    own = {"robotics": ROBOTICS, "Groups": "\n".join(["VAR_GLOBAL", *declared, "END_VAR", ""])}
    own["sample"] = text.replace(old, new) if old else text
    return compiled(name, **own)


class Picture:
    """The program of the picture, and what the element Path3D is given."""

    def __init__(self, name: str, old: str = "", new: str = "") -> None:
        library = library_of(name, old, new)
        self.program = library.new("PRG_Picture")
        self.drives = [library.constant(drive) for drive in drives_of(name)]

    def at(self, axes: tuple[float, ...]) -> NDArray[np.float64]:
        """The lines at these axis values: line, end, coordinate."""
        for drive, value in zip(self.drives, axes, strict=True):
            drive.position = value
        self.program()
        assert self.program.xReady and self.program.status == "SMC_NO_ERROR"
        return self.shown()

    def shown(self) -> NDArray[np.float64]:
        """What the element draws, by its documentation: from each point to the next one, unless bit 1 is set."""
        track = self.program.track
        assert track.pData.memory is self.program.aTrack
        assert len(self.program.aTrack) == track.udiNumberOfPointsInArray
        many = range(track.udiFirstPoint, track.udiFirstPoint + track.udiNumberOfPointsToDraw)
        points = [self.program.aTrack[k % track.udiNumberOfPointsInArray] for k in many]
        pairs = zip(points, points[1:], strict=False)
        return np.array([[(p.v.x, p.v.y, p.v.z) for p in pair] for pair in pairs if not pair[0].dwAddInfo & 2])


@cache
def machine_of(name: str) -> Machine:
    return nominal_machine(kinematics_of(MECHANISMS[name]))


@cache
def samples_of(name: str) -> list[tuple[float, ...]]:
    """Random axis values at which the machine has a pose."""
    drawn = sample_axes(MECHANISMS[name], dict(machine_of(name).values), 12, seed=8)
    rows = np.stack([drawn[joint.axis.name] for joint in MECHANISMS[name].joints], axis=1).tolist()
    return [tuple(row) for row in rows if pose_at(machine_of(name), tuple(row)) is not None]


def off_the_lines(lines: NDArray[np.float64], point: tuple[float, ...]) -> float:
    """How far a point is from the nearest line."""
    start, along = lines[:, 0], lines[:, 1] - lines[:, 0]
    square = np.maximum(np.sum(along**2, axis=1), EXACT**2)  # a line may have no length
    share = np.clip(np.sum((point - start) * along, axis=1) / square, 0.0, 1.0)
    return float(np.min(np.linalg.norm(start + share[:, None] * along - point, axis=1)))


def worst_of(name: str, picture: Picture) -> float:
    """How far the picture is from where the machine is at the samples.

    The flange is where forward kinematics of the Python package has it: there the last line ends. The drives of the
    machine, and its rods, are on the lines, as the drawing of the guide has them, which is composed number by number.
    """
    robot = robot_of(MECHANISMS[name])
    worst = 0.0
    for axes in samples_of(name):
        lines, pose = picture.at(axes), pose_at(machine_of(name), axes)
        assert pose is not None
        flange = np.array(robot.forward(axes)[0].position)
        points = picture.program.aPoints[-3:]
        scene = scene_at(machine_of(name), pose)
        rods = [end for s in scene.segments if s.body is Body.ROD for end in (s.start, s.end)]
        found = [off_the_lines(lines, point) for point in (*(turn.at for turn in scene.turns), *rods)]
        worst = max(worst, *found, *(np.abs(lines[-1, 1] - flange)), *(np.abs(points - flange)))
    return worst


def robot_of(mechanism: Mechanism) -> Any:
    (entry,) = (e for n, e in softkin.catalogue().items() if n == mechanism.name)
    return entry(**{p.name: p.nominal for p in mechanism.parameters if p.unit == "u"})


@pytest.mark.parametrize("name", SAMPLES)
def test_the_picture_moves_with_the_machine(name: str) -> None:
    """At random axis values: its flange, its drives and its rods are where the machine has them."""
    assert len(samples_of(name)) >= 8
    assert worst_of(name, Picture(name)) < EXACT


@pytest.mark.parametrize("name", SAMPLES)
def test_a_wrong_picture_is_noticed(name: str) -> None:
    """A planted fault in the drawing, in the list of its lines, in the track, or in the dimensions."""
    dimension = next(line for line in SAMPLES[name].split("\n") if line.startswith("    d") and " := " in line)
    value = dimension.split(" := ")[1].split(",")[0].rstrip(");")
    faults = [("SIN(", "COS("), ("dZ := aPoints[iPoint, 2]", "dZ := aPoints[iPoint, 1]")]
    faults.append((f" := {value}", f" := {1.02 * float(value):.3f}"))
    ends = SAMPLES[name].split(" OF INT := [")[1].split("]")[0].split(", ")
    faults.append((", ".join(ends), ", ".join([*ends[:-1], ends[-2]])))
    for old, new in faults:
        assert worst_of(name, Picture(name, old, new)) > 1.0, (old, new)


def test_a_finished_picture_is_shown_while_the_next_is_written() -> None:
    """The element reads in a task of its own: the points that it is given stay until the next picture is whole."""
    picture = Picture("Softkin_Scara2_Z")
    first = picture.at((0.0, 0.0, 0.0))
    begin = picture.program.track.udiFirstPoint
    kept = [(p.v.x, p.v.y, p.v.z) for p in picture.program.aTrack[begin : begin + 6]]
    picture.at((90.0, 0.0, 0.0))
    assert picture.program.track.udiFirstPoint != begin
    assert [(p.v.x, p.v.y, p.v.z) for p in picture.program.aTrack[begin : begin + 6]] == kept
    assert np.allclose(picture.at((0.0, 0.0, 0.0)), first) and picture.program.track.udiFirstPoint == begin


def test_axes_without_a_pose_leave_the_picture() -> None:
    """A delta whose rods are too short for horizontal arms: the status says so, and the last picture stays."""
    picture = Picture("Softkin_Delta_C", "dRodLength := 560.0", "dRodLength := 300.0")
    before = picture.at((90.0, 90.0, 90.0, 0.0))
    for drive in picture.drives:
        drive.position = 0.0
    picture.program()
    assert picture.program.status == "SMC_TRAFO_INVALID_CONSTELLATION"
    assert np.array_equal(picture.shown(), before)


@dataclass(frozen=True)
class Move:
    """What a group was told: 1 point to point, 2 along a line; the place, and the first bytes of the configuration."""

    kind: int
    place: tuple[float, ...]
    bytes: tuple[int, ...]


def moves_of(demo: Any, group: Any, cycles: int) -> list[Move]:
    """The different moves of some cycles, in their order."""
    found: list[Move] = []
    for _ in range(cycles):
        demo()
        place = group.position.c
        numbers = (place.X, place.Y, place.Z, place.A, place.B, place.C)
        now = Move(group.moved, numbers, tuple(group.kinConfig.abyData[:3]))
        if now.kind in (1, 2) and (not found or (now.kind, now.place) != (found[-1].kind, found[-1].place)):
            found.append(now)
    return found


def started(name: str) -> tuple[Any, Any]:
    library = library_of(name)
    demo = library.new("PRG_Demo")
    demo.xRepeat = False
    return demo, library.constant("Machine")


@pytest.mark.parametrize("name", SAMPLES)
def test_the_demo_moves_where_the_machine_can_go(name: str) -> None:
    """Point to point and along a line, in every configuration that it sets, as inverse kinematics in Python confirms at
    points of the line; then it stands.
    """
    mechanism = MECHANISMS[name]
    robot, size = robot_of(mechanism), len(mechanism.branches)
    demo, group = started(name)
    moves = moves_of(demo, group, 80)
    assert demo.xDone and not group.refused and demo.eError == "SMC_NO_ERROR"
    lines = [(a, b) for a, b in zip(moves, moves[1:], strict=False) if b.kind == 2]
    assert len(lines) == (1 if mechanism.chain is None else 2) and moves[0].kind == 1
    assert len({move.place for move in moves}) == 2
    for before, after in lines:
        turned = softkin.Frame.from_euler(*before.place[3:])
        chosen = tuple(byte or 1 for byte in after.bytes[:size])
        periods = (0,) * (len(robot.CONFIGURATION) - size)
        reference = (0.0,) * len(mechanism.joints)
        for share in np.linspace(0.0, 1.0, 7):
            point = (1.0 - share) * np.array(before.place[:3]) + share * np.array(after.place[:3])
            reference = robot.inverse((tuple(point), turned.rotation), (*chosen, *periods), reference)
    for _ in range(20):
        demo()
    assert demo.xDone and [move.place for move in moves_of(demo, group, 5)] == [moves[-1].place]
    demo.xRepeat = True
    assert len(moves_of(demo, group, 60)) > 2, "it begins again"


STEPS = (0, 10, 20, 30)
"""The steps in which a block is asked that moves."""


@pytest.mark.parametrize(
    ("step", "fault"), [*((step, "fault") for step in STEPS), *((step, "ownFault") for step in (*STEPS, 100))]
)
def test_the_demo_ends_in_its_error_step_and_begins_again(step: int, fault: str) -> None:
    """A fault in any step, of a block or of the group, stops it; a reset begins from power again."""
    demo, group = started("Softkin_Scara2_Z")
    for _ in range(80):
        demo()
        if demo.iStep == step:
            break
    assert demo.iStep == step
    setattr(group, fault, SMC_ERROR_OF_THE_GROUP)
    for _ in range(6):
        demo()
    assert (demo.iStep, demo.iFailed, demo.eError, demo.xDone) == (900, step, SMC_ERROR_OF_THE_GROUP, False)
    assert demo.sError == "an error"
    moved = group.moved
    for _ in range(20):
        demo()
    assert demo.iStep == 900 and group.moved == moved, "it waits, and moves nothing"
    demo.xReset = True
    for _ in range(80):
        demo()
    assert demo.xDone and not demo.xReset and demo.eError == "SMC_NO_ERROR" and not group.refused


@pytest.mark.parametrize("name", SAMPLES)
def test_the_panel_jogs_axes_and_coordinates(name: str) -> None:
    """A button jogs; the change between axes and coordinates takes a cycle in which nothing moves; an error stays until
    the panel is switched off.
    """
    library = library_of(name)
    panel, group = library.new("PRG_Jog"), library.constant("Machine")
    panel.axPlus[0] = True
    panel()
    assert not panel.xActive and group.moved == 0, "it is off"
    panel.xEnable = True
    panel()
    assert panel.xActive and (group.moved, group.system) == (3, "MCS")
    panel.xAxes, group.moved = True, 0
    panel()
    assert not panel.xActive and group.moved == 0
    panel()
    assert panel.xActive and (group.moved, group.system) == (3, "ACS")
    panel.axMinus[0], group.moved = True, 0
    panel()
    assert group.moved == 0, "both directions"
    group.fault = SMC_ERROR_OF_THE_GROUP
    for _ in range(3):
        panel()
    assert not panel.xActive and panel.eError == SMC_ERROR_OF_THE_GROUP and panel.sError == "an error"
    group.fault, panel.xEnable = "SMC_NO_ERROR", False
    panel()
    assert panel.eError == "SMC_NO_ERROR" and panel.sError == ""


PAGE = (OUTPUT.parent / "docs" / "FIRST_PROJECT.md").read_text(encoding="utf-8")


def test_the_page_names_what_there_is() -> None:
    """Its table has the samples with their drives; its variables can be read from outside, and its dimensions are those
    of the sample.
    """
    rows = re.findall(r"^\| [^|]+ \| `(\S+)` \| `samples/(\w+)\.xml` \| ([^|]+) \|$", PAGE, re.MULTILINE)
    assert {name for _, name, _ in rows} == set(SAMPLES)
    for file, name, drives in rows:
        named, (first, *_, last) = re.findall(r"`(\w+)`", drives), drives_of(name)
        assert (OUTPUT / "st" / file).exists() and file.endswith(f"/{name}.xml")
        assert named == (drives_of(name) if " to " not in drives else [first, last])
    declared = {part.path: part.declaration for part in parts_of(SAMPLES["Softkin_Scara2_Z"])}
    for program, name in re.findall(r"`(PRG_\w+)\.(\w+)", PAGE):
        outside = declared[program].split("\nVAR\n")[0]
        assert re.search(rf"^  {name} : ", outside, re.MULTILINE), name
    assert set(re.findall(r"`(PRG_\w+|SamplePoint|Softkin_\w+_Drawing)`", PAGE)) <= set(declared)
    for dimension, value in re.findall(r"`(d\w+)` (\d+)", PAGE):
        assert f"{dimension} := {value}.0" in SAMPLES["Softkin_Scara2_Z"]


@pytest.mark.parametrize("name", ["Rail", "Target", "SamplePoint"])
def test_a_machine_with_a_name_of_the_sample_comes_without(name: str) -> None:
    """Its block would be hidden by a variable, or replace an object: it is written all the same, and alone."""
    language = StructuredTextFiles()
    part = language.part(kinematics_of(next(m for _, m in catalogue() if m.name == "Kin_Gantry2")))
    files = language.files([json.loads(json.dumps(part).replace("Softkin_Gantry2", name))])
    assert f"gantry/{name}.xml" in files
    assert (f"samples/{name}.xml" in files) == (name == "Rail")
