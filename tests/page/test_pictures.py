"""The pictures of pages: the machine in a pose that is singular indeed, and maps that show what is known otherwise."""

import math
from functools import cache
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import softkin

from derive.description.validate import validate
from derive.drawing.pose import Pose, drawn_pose, nominal_machine, values_at
from derive.emit.page.page import Page, index_of, page_of
from derive.ir.interpret import evaluate
from derive.ir.interpret import run as interpreted
from derive.kinematics.sampling import size_of
from derive.report.derived import Derived, derived_of
from derive.report.reference_calls import FRAME, Machine
from derive.report.singular_poses import SINGULAR, SingularPose, singular_pose
from derive.report.workspace_map import Slice, slices
from tests.machines.subset_machines import LOOPS
from tests.mechanisms import kinematics_of, named
from tests.page.made import NAMES, page
from tests.page.reading import every, has_class, parsed, section
from tests.random_axes import random_axes

pytestmark = pytest.mark.slow

DRAWN = ("Kin_Scara4_ZCcoupled_Type1", "Kin_P2C_Type1", "Kin_Hexapod", "Kin_Polar", "Kin_Crane", "Kin_Wrist2")
SINGULAR_MACHINES = tuple(n for n in NAMES if n not in ("Kin_Tool",) and named(n).joints)
_SMALL, _NEVER = 1e-4, 0.03
_STEP = 1e-5


@cache
def _derived(name: str) -> Derived:
    return derived_of(kinematics_of(named(name)).solution)


@cache
def _machine(name: str) -> Machine:
    return nominal_machine(kinematics_of(named(name)))


def _found(name: str, margin: str) -> SingularPose | None:
    machine = _machine(name)
    return singular_pose(machine, _derived(name), margin, drawn_pose(machine).axes)


@pytest.mark.parametrize("name", SINGULAR_MACHINES)
def test_the_pose_of_a_picture_is_singular(name: str) -> None:
    """By a measure that knows no margin: for type 1 the Jacobian loses its rank; for type 2 the legs do."""
    machine = _machine(name)
    for margin in machine.kinematics.margins:
        found = _found(name, margin.name)
        if found is None and named(name).drives:  # its loops end before it vanishes
            assert _least(name, margin.name) > _NEVER, (name, margin.name)
            continue
        assert found is not None and found.value <= SINGULAR, (name, margin.name)
        if margin.kind == "type 2" and named(name).drives:
            assert _across(machine, found) <= _SMALL, (name, margin.name)
        elif margin.kind == "type 2":
            assert _held(machine, found) <= _SMALL, (name, margin.name)
        elif found.frame is None:
            assert _rank(machine, found) <= _SMALL, (name, margin.name)


def _least(name: str, margin: str) -> float:
    robot = softkin.catalogue()[name](**{p.name: p.nominal for p in named(name).parameters})
    rows = random_axes(robot, 1000, np.random.default_rng(3))
    return min(abs(robot.singularity(row).margins[margin]) for row in rows)


def _across(machine: Machine, found: SingularPose) -> float:
    """The sine between a rod or cylinder and the lever that it moves: the least of all loops, which close there."""
    values, sines = values_at(machine, Pose(found.axes, (0.0,) * len(FRAME), ())), []
    for loop in (loop for joint in machine.kinematics.mechanism.joints for loop in joint.loops):
        vectors = loop.vector, loop.vector.diff(loop.moved)
        rod, moved = (np.array([float(evaluate(e, values)) for e in v]) for v in vectors)
        assert np.linalg.norm(rod) == pytest.approx(float(evaluate(loop.length, values)), rel=1e-9)
        sines.append(abs(rod @ moved) / np.linalg.norm(rod) / np.linalg.norm(moved))
    return float(min(sines))


def _rank(machine: Machine, found: SingularPose) -> float:
    """The smallest singular value of the Jacobian beside its largest, lengths in lengths of the machine, in a hair's
    distance, where the Jacobian of a loop is still finite.
    """
    kinematics = machine.kinematics
    joints = kinematics.mechanism.joints
    size = size_of(kinematics.mechanism, machine.values)
    values, _ = interpreted(
        kinematics.jacobian,
        {**machine.values, **{j.axis.name: np.asarray(v) for j, v in zip(joints, found.axes, strict=True)}},
    )
    entries = [float(v) for v in values.values()]
    matrix = np.array(entries).reshape(len(kinematics.rows), len(joints))
    matrix = matrix * [[1.0 / size if r in "xyz" else 1.0] for r in kinematics.rows]
    matrix = matrix * [1.0 if j.is_angle else size for j in joints]
    matrix = matrix[:, [j in kinematics.mechanism.solved_joints for j in joints]]
    sizes = np.linalg.svd(matrix, compute_uv=False)
    return float(sizes[-1] / sizes[0]) if np.isfinite(sizes).all() else math.inf


def _held(machine: Machine, found: SingularPose) -> float:
    """How far the tool goes, at least, without any closure equation noticing: the smallest singular value of dΦ/dx by
    differences, each row of length one.
    """
    mechanism = machine.kinematics.mechanism
    values = dict(machine.values)
    for joint, axis in zip(mechanism.joints, found.axes, strict=True):
        motor = axis * float(evaluate(joint.unit, values))
        values[joint.motor.name] = np.asarray(motor)
        values[joint.symbol.name] = np.asarray(motor * evaluate(joint.ratio, values) + evaluate(joint.coupling, values))
    frame = found.frame
    if frame is None:
        given = {j.axis.name: np.asarray(v) for j, v in zip(mechanism.joints, found.axes, strict=True)}
        pose, _ = interpreted(machine.kinematics.forward, {**machine.values, **given})
        frame = tuple(float(pose[n]) for n in FRAME)
    size = size_of(mechanism, machine.values)
    directions = [k for k, c in enumerate("xyz") if c in mechanism.motion.position]
    rotation_axes = [] if found.frame is None else [2] if mechanism.motion.turning.value == "about z" else [0, 1, 2]
    columns = []
    for place in directions:
        shift = np.zeros(3)
        shift[place] = _STEP * size
        columns.append(_slope(mechanism, values, frame, shift, np.zeros(3)))
    for place in rotation_axes:
        turn = np.zeros(3)
        turn[place] = _STEP
        columns.append(_slope(mechanism, values, frame, np.zeros(3), turn))
    matrix = np.array(columns).T
    sizes = np.linalg.norm(matrix, axis=1, keepdims=True)
    matrix = matrix / np.maximum(sizes, 1e-6 * np.max(sizes))  # an equation that notices nothing stays short
    return float(np.linalg.svd(matrix, compute_uv=False)[-1])


def _slope(mechanism, values, frame, shift, turn) -> list[float]:  # type: ignore[no-untyped-def]
    found = []
    for sign in (1.0, -1.0):
        position = np.array(frame[:3]) + sign * shift
        wx, wy, wz = sign * turn
        spin = np.array([[0.0, -wz, wy], [wz, 0.0, -wx], [-wy, wx, 0.0]])
        rotation = (np.eye(3) + spin + spin @ spin / 2) @ np.array(frame[3:]).reshape(3, 3)
        named_values = dict(zip(FRAME, (*position, *rotation.ravel()), strict=True))
        known = {**values, **{n: np.asarray(v) for n, v in named_values.items()}}
        known |= {n.capitalize(): v for n, v in known.items() if n in ("x", "y", "z")}
        found.append([float(evaluate(e, known)) for e in mechanism.equations])
    return [(a - b) / (2 * _STEP) for a, b in zip(*found, strict=True)]


def test_a_search_that_finds_nothing_says_so() -> None:
    """The rod of a slide is longer than its crank, and never lies across the slide: type 2 alone has no picture."""
    mechanism = validate(LOOPS["crank that lifts a slide"])
    kinematics = kinematics_of(mechanism)
    page = parsed(page_of(mechanism, kinematics).text)
    shown = {figure.get("data-margin") for figure in page.iter()} - {None}
    assert shown == {m.name for m in kinematics.margins if m.kind == "type 1"} != set()
    told = "".join(text for part in every(page, "section") for text in part.itertext())
    assert told.count("No pose of the nominal machine was found in which it is zero.") == 1


@cache
def _page(name: str) -> Page:
    mechanism = named(name)
    return page_of(mechanism, kinematics_of(mechanism))


@pytest.mark.parametrize("name", DRAWN)
def test_every_picture_is_on_the_page(name: str) -> None:
    """The drawing, a picture for each singularity with a value that is zero, and the maps; the page stays small."""
    page, kinematics = parsed(_page(name).text), kinematics_of(named(name))
    drawing = next(every(section(page, "machine"), "figure", "picture"))
    letters = {"".join(t.itertext()) for t in drawing.iter() if t.tag.endswith("}text")}
    assert {j.name for j in kinematics.mechanism.joints} <= {
        w for text in letters for w in text.replace("−", " ").split()
    }
    shown = {f.get("data-margin"): float(str(f.get("data-value"))) for f in page.iter() if f.get("data-margin")}
    assert list(shown) == [m.name for m in kinematics.margins]
    assert all(value <= SINGULAR for value in shown.values())
    maps = list(every(section(page, "workspace"), "figure", "map"))
    assert len(maps) == {"xyz": 2, "xy": 1}.get(kinematics.mechanism.task.position, 0)
    for image in (i for figure in maps for i in every([figure], "img")):
        assert str(image.get("src")).startswith("data:image/svg+xml;base64,")
    assert len(_page(name).text.encode()) < 1_000_000


@pytest.mark.parametrize("name", ("Kin_P2C_Type1",))
def test_a_page_is_the_same_again(name: str) -> None:
    """No date, no hash: twice made, a page has the same bytes."""
    mechanism = named(name)
    assert page_of(mechanism, kinematics_of(mechanism)).text == _page(name).text


def _slices(name: str) -> dict[tuple[str, str], Slice]:
    machine = _machine(name)
    pose = drawn_pose(machine)
    return {part.along: part for part in slices(machine, pose.frame, pose.axes)}


def _middles(part: Slice) -> tuple[np.ndarray, np.ndarray]:
    rows, columns = part.solutions.shape
    (left, right), (low, high) = part.ends
    x = left + (np.arange(columns) + 0.5) * (right - left) / columns
    y = low + (np.arange(rows) + 0.5) * (high - low) / rows
    first, second = np.meshgrid(x, y)
    return first, second


def test_a_map_shows_the_ring_of_a_scara() -> None:
    """Two solutions where |L1 − L2| < r < L1 + L2, none elsewhere; the margin is the sine of the elbow."""
    name = "Kin_Scara2_Z"
    part = _slices(name)["x", "y"]
    x, y = _middles(part)
    one, two = (p.nominal for p in named(name).parameters if p.unit == "u" and p.role.value == "length")
    reach = np.hypot(x, y)
    inside = (reach > abs(one - two)) & (reach < one + two)
    assert np.array_equal(part.solutions, np.where(inside, 2.0, 0.0)) and 0.2 < inside.mean() < 0.9
    cosine = (reach**2 - one**2 - two**2) / (2.0 * one * two)
    np.testing.assert_allclose(part.margin[inside], np.sqrt(1.0 - cosine[inside] ** 2), atol=1e-9)
    assert np.isnan(part.margin[~inside]).all()


def test_a_map_shows_the_two_circles_of_a_five_bar() -> None:
    """A point is reached at most where both arms reach it."""
    name = "Kin_P2C_Type1"
    (part,) = _slices(name).values()
    assert part.solutions.max() == 4.0 and (part.solutions == 0.0).any()
    assert np.isnan(part.margin[part.solutions == 0.0]).all()


def test_the_index_names_every_page() -> None:
    """Each page with its file, by families."""
    pages = [page(name) for name in DRAWN]
    index = index_of(pages)
    root: ET.Element = parsed(index)
    links = {a.get("href"): "".join(a.itertext()) for a in every([root], "a")}
    assert links == {page.file: page.title for page in pages}
    assert not any(has_class(e, "picture") for e in root.iter())
