"""Belts, parallelograms, wrists and both ways of a byte: what is drawn moves as the mechanism does."""

from dataclasses import replace

import numpy as np
import pytest
import softkin

from derive.description.mechanism import DescriptionError
from derive.drawing.drawing import Drawing, drawing_of, is_turned_round, looks_alike
from derive.drawing.scene import Belt, Body
from derive.emit.picture import style
from derive.emit.picture.ink import Area, Line
from derive.emit.picture.machine import Machine
from derive.emit.picture.view import Box
from derive.kinematics.build import build
from tests.random_axes import random_axes
from tests.unit.drawing.machines import CATALOGUE, drawn

pytestmark = pytest.mark.slow

BELTS = ("Kin_HGantry2", "Kin_HGantry3", "Kin_TGantry2", "Kin_TGantry3", "Kin_P2Y")
DELTAS = ("Kin_Delta_P3C_Type3", "Softkin_Delta_C", "Kin_Tripod_Linear", "Kin_Tripod_P3Z")
NONE = ("Kin_Tripod_Rotary", "Kin_Hexapod", "Softkin_DualScara", "Kin_Crane", "Kin_P2C_Type1")


def _belt(name: str) -> Belt:
    belt = drawn(name).drawing.scene.belt
    assert belt is not None
    return belt


@pytest.mark.parametrize("name", BELTS)
@pytest.mark.parametrize("number", [0, 1])
def test_a_motor_pulls_the_carriage_where_its_drive_moves_it(name: str, number: int) -> None:
    """By hand: the strand from the carriage to the left motor gets longer by x - y, that to the right one by -x - y.

    So the belt runs past a motor, away from the carriage's end of it, by the negative of that. In an H this end arrives
    at the outer side of the motor, downward; in a T at the lower side, outward.
    """
    one, belt = drawn(name), _belt(name)
    drive = one.mechanism.joints[number].name
    (motor,) = [m for m in belt.motors if str(m.label) == drive]
    side = np.sign(motor.at[0])
    axes = np.eye(len(one.mechanism.joints))[number]
    x, y = one.closure.frame(one.joints_at(axes[None, :]), one.parameters)[0, :2, 0]
    past, other = y + side * x, y - side * x
    assert abs(past) == pytest.approx(1.0) and other == pytest.approx(0.0), "it runs past its own motor alone"
    is_h = one.mechanism.belt == "H"
    arm, velocity = ((side, 0, 0), (0, -past, 0)) if is_h else ((0, -1, 0), (side * past, 0, 0))
    assert np.cross(motor.axis, arm) == pytest.approx(np.array(velocity, dtype=float))


@pytest.mark.parametrize("name", BELTS)
def test_a_belt_goes_around_its_wheels(name: str) -> None:
    """It is one line without jumps, at a wheel's radius from each wheel, and never nearer."""
    belt = _belt(name)
    path = np.array(belt.path)
    for centre in (*belt.wheels, *(m.at for m in belt.motors)):
        distance = np.linalg.norm(path - np.array(centre), axis=1)
        assert np.min(distance) == pytest.approx(belt.radius)
    steps = np.diff(path, axis=0)
    turns = [np.dot(a, b) / np.linalg.norm(a) / np.linalg.norm(b) for a, b in zip(steps, steps[1:], strict=False)]
    assert min(turns) > np.cos(np.radians(25.0)), "it bends on wheels alone"


def test_a_belt_of_another_kind_is_refused() -> None:
    """A layout that is none, and one whose drives do not share two slides."""
    for mechanism, message in (
        (replace(CATALOGUE["Kin_HGantry2"], belt="X"), "belt must be one of 'H', 'T', not 'X'"),
        (replace(CATALOGUE["Kin_Gantry2"], belt="H"), "a belt in H layout moves two slides, and here 0"),
    ):
        with pytest.raises(DescriptionError, match=message):
            drawing_of(build(mechanism))


@pytest.mark.parametrize("name", DELTAS)
def test_rods_that_keep_a_plate_level_are_parallelograms(name: str) -> None:
    """Each of the three rods is a pair; the pair is square to it, and along the axis of its crank where it has one."""
    scene = drawn(name).drawing.scene
    rods = [s for s in scene.segments if s.body is Body.ROD]
    assert len(rods) == 3
    cranks = [t for t in scene.turns if t.zero is not None or t.toward is not None]
    for k, rod in enumerate(rods):
        assert rod.across is not None
        side = np.array(rod.across)
        if cranks:
            assert np.linalg.norm(np.cross(side, cranks[k].axis)) < 1e-6
        else:
            assert abs(side @ np.subtract(rod.end, rod.start)) < 1e-6


@pytest.mark.parametrize("name", NONE)
def test_other_rods_are_single(name: str) -> None:
    """A plate that turns, a plane, and pairs that the description states itself."""
    assert all(s.across is None for s in drawn(name).drawing.scene.segments)


@pytest.mark.parametrize(
    ("name", "names"),
    [("Kin_ArticulatedRobot_6DOF", "A4 A5 A6"), ("Kin_Wrist3", "A B C"), ("Kin_Ac6_TXTYTZRYRXRZ", "A4 A5 A6")],
)
def test_axes_of_a_wrist_meet(name: str, names: str) -> None:
    """The point is on each of the three axes."""
    scene = drawn(name).drawing.scene
    ((place, meeting),) = scene.meetings
    assert " ".join(sorted(map(str, meeting))) == names
    for turn in (t for t in scene.turns if t.label in meeting):
        assert np.linalg.norm(np.cross(np.subtract(place, turn.at), turn.axis)) < 1e-6


@pytest.mark.parametrize("name", ["Kin_Ac6_RZRYRYRXRYRZ_J6Offset", "Kin_Ac6_ThreeParallel", "Softkin_HeadTable_BC"])
def test_axes_that_pass_each_other_do_not_meet(name: str) -> None:
    """An offset wrist, three parallel axes, two axes."""
    assert not drawn(name).drawing.scene.meetings


@pytest.mark.parametrize("name", ["Kin_ArticulatedRobot_6DOF", "Kin_Wrist3", "Kin_Ac6_TXTYTZRYRXRZ"])
def test_a_wrist_is_drawn_with_one_centre(name: str) -> None:
    """The lines of its three axes go through one point of the page, where a ball is; none of them has a body."""
    drawing = drawn(name).drawing
    marks = Machine(drawing, Box(0.0, 0.0, 480.0, 400.0), {}).drawn()
    axes = [np.array(m.points) for m in marks if isinstance(m, Line) and m.dashes == (9.0, 3.0, 2.0, 3.0)][-3:]
    balls = [np.mean(m.points, axis=0) for m in marks if isinstance(m, Area) and m.fill == style.JOINT]
    assert any(all(_aside(ball, ends) < 0.2 for ends in axes) for ball in balls)
    cylinders = [m for m in marks if isinstance(m, Area) and m.fill == "#eef4fb"]
    assert len(cylinders) == len(drawing.scene.turns) - 3


def _aside(place: np.ndarray, ends: np.ndarray) -> float:
    """The distance of a point of the page from a line."""
    (x, y), (u, v) = ends[1] - ends[0], place - ends[0]
    return float(abs(x * v - y * u) / np.hypot(x, y))


def _first(name: str) -> Drawing:
    return drawn(name).drawing


@pytest.mark.parametrize("name", [n for n, m in CATALOGUE.items() if m.branches])
def test_byte_0_has_a_picture(name: str) -> None:
    """Both of its ways differ, in where bodies are or in where the axis of a joint points."""
    scenes = _first(name).choices[0].scenes
    if scenes is None and CATALOGUE[name].drives:  # with its dimensions the loops end before the other way
        assert not _both_ways(name)
        return
    assert scenes is not None
    one, other = scenes
    turned = [a for a, b in zip(one.turns, other.turns, strict=True) if is_turned_round(a, b)]
    assert turned or not looks_alike(one, other)
    assert (_first(name).choices[0].assemblies is None) == (name != "MC_KIN_TYPE_12_XY")


def _both_ways(name: str) -> bool:
    """Whether some random pose has solutions with both values of byte 0."""
    robot = softkin.catalogue()[name](**{p.name: p.nominal for p in CATALOGUE[name].parameters})
    axes = random_axes(robot, 2000, np.random.default_rng(3))
    positions, rotations, _, _ = robot.forward_batch(axes)
    found = robot.inverse_all_batch(positions, rotations, axes)[1] == softkin.Status.OK
    assert found.any(axis=1).all()
    return bool((found[:, ::2].any(axis=1) & found[:, 1::2].any(axis=1)).any())


def test_ways_that_no_assembly_has_both_of() -> None:
    """Of type 12 with its dimensions the upper arm is on the left in one assembly, on the right in the other; each pose
    is on the side that its name says, with a closed loop.
    """
    choice = _first("MC_KIN_TYPE_12_XY").choices[0]
    assert choice.names == choice.assemblies == ("left", "right") and choice.scenes is not None
    for scene, side in zip(choice.scenes, (1.0, -1.0), strict=True):
        tcp = np.array(scene.tool.position[:2])
        ends = np.array([[s.start[:2], s.end[:2]] for s in scene.segments]).reshape(-1, 2)
        shoulder = next(p for p in ends if np.linalg.norm(p - tcp) == pytest.approx(350.0, abs=1e-6))
        assert np.linalg.norm(shoulder) == pytest.approx(300.0, abs=1e-6)
        to_origin, to_shoulder = -tcp, shoulder - tcp
        assert side * (to_origin[0] * to_shoulder[1] - to_origin[1] * to_shoulder[0]) > 0.0
