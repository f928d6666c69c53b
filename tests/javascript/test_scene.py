"""What is drawn of a machine: it follows the machine, rods keep their lengths, and lines are those of the drawing."""

from typing import Any

import numpy as np
import pytest
import softkin
from numpy.typing import NDArray

from derive.drawing.drawing import nominal_machine, scene_at
from derive.drawing.pose import Pose, drawn_pose
from derive.drawing.scene import Scene
from derive.ir.interpret import evaluate
from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.recording import read
from tests.javascript.modules import module_of
from tests.javascript.node import ask
from tests.mechanisms import kinematics_of, named

Array = NDArray[np.float64]
DRAWN = (
    "Kin_Scara4_ZCcoupled_Type1", "Kin_Pos_RRR", "Kin_P2C_Type1", "Kin_Hexapod", "Kin_Wrist2", "Kin_Crane",
    "Kin_Delta_P3C_Type3", "Kin_Tripod_Linear", "Softkin_Delta_C", "Kin_HGantry3",
)  # fmt: skip
"""A mechanism of each kind that is drawn in a way of its own."""


MOTORS = {
    "Kin_ArticulatedRobot_6DOF": ["A1", "A2", "A3", "A4", "A5", "A6"],
    "Kin_Delta_P3C_Type3": ["A1", "A2", "A3"],
    "Softkin_TableTable_AC": ["A", "C"],
    "Softkin_Excavator": ["A1"],
    "Softkin_RodPalletizer": ["A1", "A4", "M3"],
    "Kin_Gantry3": [],
    "Kin_Hexapod": [],
}
"""The axes that a motor at their joint turns, or at the crank of their loop: no cylinder, and no slide."""


def scenes(name: str, parameters: dict[str, Any], rows: list[list[float]]) -> list[Any]:
    """The scenes at axis values, each with the answer of forward kinematics."""
    calls = [[call, axes] for axes in rows for call in ("scene", "forward")]
    found = ask(module_of(name), [{"parameters": parameters, "calls": calls}])["answers"][0]["found"]
    return list(zip(found[::2], found[1::2], strict=True))


@pytest.mark.broad
@pytest.mark.parametrize("name", DIMENSIONS)
def test_bodies_follow_the_machine(name: str) -> None:
    """At random poses: the last body ends at the tool, frames are rotations, and no body changes its shape."""
    part = read(name)[0]
    parameters = part["recipe"][0]["parameters"]
    rows = [q["axes"] for q in part["asked"] if q["call"] == "forward" and q["kind"] == "regular"][:5]
    if not rows:
        rows = [[0.0] * len(softkin.catalogue()[name].AXES)]
    found = scenes(name, parameters, rows)
    shapes = []
    for scene, forward in found:
        assert scene["status"] == forward["status"] == 0
        bodies, joints = scene["bodies"], scene["joints"]
        assert bodies[0]["kind"] == "base" and bodies[-1]["kind"] == "tool"
        assert bodies[-1]["frame"] == forward["frame"]
        for body in bodies:
            rotation = np.array(body["frame"]["rotation"])
            assert np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-9) and np.linalg.det(rotation) > 0.0
        moved = {axis for joint in joints for axis in joint["joints"]}
        assert moved == {axis.name for axis in softkin.catalogue()[name].AXES}
        assert all(np.isclose(np.linalg.norm(joint["axis"]), 1.0) for joint in joints)
        assert name not in MOTORS or sorted(" ".join(m["joints"]) for m in scene["motors"]) == MOTORS[name]
        _check_motors(scene)
        quill = any(joint["kind"] == "slide" and joint["body"] == len(bodies) - 1 for joint in joints)
        changing = {"plate"} if quill else set()  # the quill shifts the tool against it
        own = [b for b in bodies[:-1] if b["kind"] not in changing and not (b["kind"] == "rod" and b["joints"])]
        shapes.append([sorted(_own_points(body)) for body in own])
        if named(name).chain is not None:
            rods = [k for k, body in enumerate(bodies) if body["kind"] == "rod"]
            last = bodies[(*rods, len(bodies) - 1)[0] - 1]  # of the chain: loops that move joints stand behind it
            end = last["lines"][-1][1] if last["lines"] else last["frame"]["position"]
            assert end == pytest.approx(forward["frame"]["position"], abs=1e-9)
    for shape in shapes[1:]:
        for one, other in zip(shapes[0], shape, strict=True):
            assert np.allclose(one, other, atol=1e-6, rtol=1e-9)


def _check_motors(scene: dict[str, Any]) -> None:
    """Each is at its joint, along its axis; of a crank at the first pin of the crank."""
    for motor in scene["motors"]:
        same = [j for j in scene["joints"] if j["joints"] == motor["joints"] and j["kind"] == "turn"]
        pins = [b["lines"][0][0] for b in scene["bodies"] if b["name"].startswith("crank")]
        assert motor["at"] in [*(j["at"] for j in same), *pins]
        assert np.linalg.norm(motor["axis"]) == pytest.approx(1.0)
        assert motor["at"] in pins or abs(np.dot(same[0]["axis"], motor["axis"])) == pytest.approx(1.0)


def _own_points(body: dict[str, Any]) -> list[float]:
    """The distances of the points of a body from the origin of its frame."""
    return [float(np.linalg.norm(np.subtract(p, body["frame"]["position"]))) for line in body["lines"] for p in line]


@pytest.mark.parametrize("name", ["Kin_HGantry3", "Kin_TGantry2", "Kin_P2Y"])
def test_a_belt_moves_with_the_carriage(name: str) -> None:
    """It keeps its length in a plane and holds the carriage; a drive pulls it past its own motor alone."""
    axes = np.array([50.0, 90.0, -80.0][: len(softkin.catalogue()[name].AXES)])
    rows = [axes, axes + np.eye(len(axes))[0], axes + np.eye(len(axes))[1]]
    found = [scene for scene, _ in scenes(name, {}, [row.tolist() for row in rows])]
    belts, bodies = [scene["belt"] for scene in found], found[0]["bodies"]
    paths = [np.array(belt["path"]) for belt in belts]
    lengths = [np.linalg.norm(np.diff(path, axis=0), axis=1) for path in paths]
    assert np.ptp([length.sum() for length in lengths]) < 1e-9
    assert np.ptp((paths[0] - belts[0]["carriage"]) @ belts[0]["normal"]) < 1e-9
    assert belts[0]["carriage"][:2] == pytest.approx(bodies[-1]["frame"]["position"][:2])
    assert [wheel["joint"] for wheel in belts[0]["wheels"] if wheel["joint"]] == _motors_of(found, lengths)
    assert found[0]["motors"] == [] and all(len(scene["belt"]["frame"]) >= 2 for scene in found)


def _motors_of(found: list[Any], lengths: list[Array]) -> list[str]:
    """For each wheel that a motor turns, the axis of which a unit changes the belt before it by one."""
    motors = [np.array(wheel["at"]) for wheel in found[0]["belt"]["wheels"] if wheel["joint"]]
    path, names = np.array(found[0]["belt"]["path"]), [j["joints"] for j in found[0]["joints"]][0]
    turned = []
    for at in motors:
        near = int(np.abs(np.linalg.norm(path - at, axis=1) - found[0]["belt"]["radius"]).argmin())
        pulled = [abs(length[:near].sum() - lengths[0][:near].sum()) for length in lengths[1:]]
        assert sorted(pulled) == pytest.approx([0.0, 1.0], abs=1e-9)
        turned.append(names[int(np.argmax(pulled))])
    return turned


@pytest.mark.broad
@pytest.mark.parametrize("name", DIMENSIONS)
def test_rods_are_as_long_as_stated(name: str) -> None:
    """The ends of every bar are apart by its length."""
    mechanism = named(name)
    bars = mechanism.bars or mechanism.rods
    machine = nominal_machine(kinematics_of(mechanism))
    parameters = {p.name: p.nominal for p in kinematics_of(mechanism).parameters}
    pose = drawn_pose(machine) if bars else None
    if pose is None:
        assert mechanism.chain is not None
        return
    ((scene, _),) = scenes(name, parameters, [ask(module_of(name), [])["description"]["drawn"]])
    rods = [body for body in scene["bodies"] if body["kind"] == "rod"]
    assert list(dict.fromkeys(rod["name"] for rod in rods)) == [bar.name for bar in bars]
    assert {rod["name"]: rod["isCable"] for rod in rods} == {bar.name: bar.only_pulls for bar in bars}
    values = dict(machine.values) | {
        j.symbol.name: np.asarray(a * float(evaluate(j.unit, dict(machine.values))))
        for j, a in zip(mechanism.joints, pose.axes, strict=True)
    }
    lengths = {bar.name: abs(float(evaluate(bar.length, values))) for bar in bars}
    for rod in rods:
        ((start, end),) = rod["lines"]
        assert np.linalg.norm(np.subtract(start, end)) == pytest.approx(lengths[rod["name"]], abs=1e-4)


@pytest.mark.parametrize("name", DRAWN)
def test_the_lines_are_those_of_the_drawing(name: str) -> None:
    """Every line and every axis of the drawing is there, and no other."""
    kinematics = kinematics_of(named(name))
    machine = nominal_machine(kinematics)
    pose: Pose = drawn_pose(machine)
    drawn = scene_at(machine, pose)
    parameters = {p.name: p.nominal for p in kinematics.parameters}
    ((scene, _),) = scenes(name, parameters, [list(map(float, pose.axes))])
    slides = [j for j in scene["joints"] if j["kind"] == "slide"]
    ways = [(j["at"], np.subtract(j["at"], np.multiply(j["travel"], j["axis"]))) for j in slides]
    lines = [line for body in scene["bodies"] for line in body["lines"]]
    own, shown = {_key(*line) for line in lines}, _drawn_lines(drawn)
    assert shown <= own | {_key(*way) for way in ways} and own <= shown
    turns = {(_rounded(j["at"]), _rounded(j["axis"])) for j in scene["joints"] if j["kind"] == "turn"}
    assert turns == {(_rounded(t.at), _rounded(t.axis)) for t in drawn.turns}


def _drawn_lines(scene: Scene) -> set[Any]:
    found = set()
    for s in scene.segments:
        sides = [(1, s.across), (-1, s.across)] if s.across is not None else [(0, (0.0, 0.0, 0.0))]
        found |= {_key(np.add(s.start, np.multiply(k, a)), np.add(s.end, np.multiply(k, a))) for k, a in sides}
    return found


def _key(start: Any, end: Any) -> Any:
    return tuple(sorted((_rounded(start), _rounded(end))))


def _rounded(point: Any) -> tuple[float, ...]:
    return tuple((np.round(np.array(point, dtype=float), 3) + 0.0).tolist())
