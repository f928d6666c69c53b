"""Platforms that planes hold: what the task does not command follows from the planes, in both languages."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
import softkin
import sympy as sp
from numpy.testing import assert_allclose
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism, Turning
from derive.description.validate import validate
from derive.ir.interpret import evaluate
from derive.ir.symbols import ROTATION_ENTRIES
from derive.pipeline import Built
from tests.catalogue.mounted.machines import BASE
from tests.catalogue.mounted.test_velocities import matrix_of, rows_of
from tests.catalogue.refusals import refusal
from tests.machines.both import forward_in_both, in_both, inverse_in_both
from tests.machines.guided import GUIDED
from tests.machines.made import Array
from tests.orthonormal import rodrigues, swings
from tests.text.controller import UNREACHABLE, Controller

pytestmark = pytest.mark.slow

EVERY = pytest.mark.parametrize("name", GUIDED)
TILTING = [name for name, m in GUIDED.items() if m.task.turning is Turning.DIRECTION]
PENTAPOD = "pentapod, whose struts end on the spindle and on rings around it"
SOLUTIONS = {
    "3-RPS on a raised base": 1,
    "Z3 head with slides": 4,
    "head in metres whose planes form a T, stated as equations": 4,
    "3-RRR on a lift": 7,
    "tripod whose planes form a T, over a table with two slides": 1,
    PENTAPOD: 1,
    "plate on two cylinders along a skewed guide": 1,
}
"""The most solutions in the assembly mode of the machine, at the poses where the witness counts them."""
_CLOSED, _SAME, _FEW = 1e-9, 1e-8, 10


@dataclass(frozen=True)
class Guided:
    """One machine, derived, in both languages, with offsets that are not zero."""

    mechanism: Mechanism
    built: Built
    robot: softkin.Mechanism
    controller: Controller
    size: float


@cache
def guided(name: str) -> Guided:
    mechanism = validate(GUIDED[name])
    size = max(abs(p.nominal) for p in mechanism.parameters)
    offsets = {j.offset.name: (7.0 if j.is_angle else 0.01 * size) * k for k, j in enumerate(mechanism.joints, 1)}
    return Guided(mechanism, *in_both(mechanism, offsets), size)


def rotation(*turns: tuple[int, float]) -> Array:
    """The product of turns about axes, in radians."""
    found = np.eye(3)
    for axis, angle in turns:
        found = found @ rodrigues(np.eye(3)[axis], angle)
    return found


def home_of(one: Guided) -> tuple[Array, Array]:
    """The home pose, as its words say: position, and Rz(yaw) Ry(pitch) Rx(roll)."""
    stated = [float(v) for v in one.mechanism.home]
    width = 2 if len(stated) == 3 else 3
    position = np.array([*stated[:width], *[0.0] * (3 - width)])
    turns = (0.0, 0.0, *stated[width:]) if len(stated) - width == 1 else tuple(stated[width:])
    return position, rotation((2, turns[2]), (1, turns[1]), (0, turns[0]))


def commands(one: Guided, count: int, seed: int = 7, size: float = 1.0) -> list[softkin.Frame]:
    """Frames around home, with values of their own of what is not commanded."""
    rng, (position, turned) = np.random.default_rng(seed), home_of(one)
    found = []
    for _ in range(count):
        shift = rng.uniform(-1.0, 1.0, 3) * 0.12 * one.size * size
        if "z" not in one.mechanism.motion.position:
            shift[2] = 0.0
        aside = np.where([c in one.mechanism.task.position for c in "xyz"], 0.0, rng.uniform(-2.0, 2.0, 3) * one.size)
        aside[2] = 0.0
        tilt = rng.uniform(-0.5, 0.5, 3) * size
        if one.mechanism.task.turning is Turning.DIRECTION:
            turns = ((0, tilt[0]), (1, tilt[1]), (2, rng.uniform(-np.pi, np.pi)))
        else:
            turns = ((2, tilt[2]),)
        rows = turned @ rotation(*turns)
        found.append(softkin.Frame(tuple(position + shift + aside), tuple(map(tuple, rows.tolist()))))
    return found


def residual(one: Guided, axes: Array, frame: softkin.Frame) -> float:
    """The largest residual of the description at a pose: rods in lengths, planes in lengths, over the size."""
    values = {p.name: np.asarray(p.nominal) for p in one.mechanism.parameters}
    for joint, value in zip(one.mechanism.joints, axes, strict=True):
        own = value - one.robot.parameters[joint.offset.name]
        values[joint.symbol.name] = np.asarray(np.radians(own) if joint.is_angle else own)
    values |= {c: np.asarray(p) for c, p in zip("xyz", frame.position, strict=True)}
    values |= {r.name: np.asarray(v) for r, v in zip(ROTATION_ENTRIES, np.ravel(frame.rotation), strict=True)}
    rods = [
        np.sqrt(sum(evaluate(p - b, values) ** 2 for p, b in zip(r.end, r.base, strict=True)))
        - evaluate(r.length, values)
        for r in one.mechanism.rods
    ]
    planes = [evaluate(sp.sympify(e), values) for e in one.mechanism.equations[: -len(rods)]]
    return float(np.abs([*rods, *planes]).max()) / one.size


@EVERY
def test_the_witness_counts_the_solutions(name: str) -> None:
    """Its search knows the description alone, and commands other values of what is not commanded."""
    evidence = guided(name).built.evidence
    assert evidence is not None and evidence.inverted is not None
    assert evidence.inverted.solutions == SOLUTIONS[name]


@EVERY
def test_every_solution_closes_at_what_is_commanded(name: str) -> None:
    """Forward from near the command: every equation holds there, and what is commanded is met."""
    one, answered, most = guided(name), 0, 0
    task = one.mechanism.task
    for frame in commands(one, 16):
        solutions = [s.axes for s in one.robot.inverse_all(frame, [0.0] * len(one.mechanism.joints)) if s.axes]
        most, answered = max(most, len(solutions)), answered + bool(solutions)
        for axes in solutions:
            place = tuple(frame.position[k] if c in task.position else home_of(one)[0][k] for k, c in enumerate("xyz"))
            start = softkin.Frame(place, _untwisted(one, frame))
            reached, _ = one.robot.forward(axes, start)  # type: ignore[call-arg]
            assert residual(one, np.array(axes), reached) < _CLOSED
            wanted = [c in task.position for c in "xyz"]
            assert_allclose(np.array(reached.position)[wanted], np.array(frame.position)[wanted], atol=_SAME * one.size)
            columns = [2] if task.turning is Turning.DIRECTION else [0, 1, 2]
            assert_allclose(np.array(reached.rotation)[:, columns], np.array(frame.rotation)[:, columns], atol=_SAME)
            back = [s.axes for s in one.robot.inverse_all(reached, axes) if s.axes]
            assert min(np.abs(np.subtract(b, axes)).max() for b in back) < _SAME * max(one.size, 180.0)
    assert answered > 8 and most >= min(2, SOLUTIONS[name])


def _untwisted(one: Guided, frame: softkin.Frame) -> softkin.Rotation:
    """The rotation with the tool direction of a frame and the least turn from home: a start for Newton's method."""
    if one.mechanism.task.turning is not Turning.DIRECTION:
        return frame.rotation
    return tuple(map(tuple, swings(np.array([0.0, 0.0, 1.0]), np.array(frame.rotation)[:, 2])))  # type: ignore[return-value]


def test_a_free_twist_is_that_of_the_least_turn_from_home() -> None:
    """From any start: the angle of the turn from home is that between the directions of the tool."""
    one = guided(PENTAPOD)
    _, home = home_of(one)
    for frame in commands(one, 8, seed=12, size=0.6):
        axes = one.robot.inverse(frame)
        found = [np.array(one.robot.forward(axes, *start)[0].rotation) for start in ((), (frame,))]
        assert_allclose(found[0], found[1], atol=_SAME)
        assert_allclose((np.trace(home.T @ found[0]) - 1.0) / 2.0, home[:, 2] @ found[0][:, 2], atol=1e-12)


@EVERY
def test_nothing_depends_on_what_is_not_commanded(name: str) -> None:
    """The answer for the reached frame is the same with other passive coordinates and another twist."""
    one, rng = guided(name), np.random.default_rng(9)
    passive = [k for k, c in enumerate("xyz") if c in one.mechanism.passive]
    for frame in commands(one, 12, seed=11):
        first = [s.axes for s in one.robot.inverse_all(frame, [0.0] * len(one.mechanism.joints))]
        position = np.array(frame.position)
        position[passive] = rng.uniform(-3.0, 3.0, len(passive)) * one.size
        twist = rng.uniform(-np.pi, np.pi) if "twist" in one.mechanism.passive else 0.0
        other = softkin.Frame(tuple(position), tuple(map(tuple, np.array(frame.rotation) @ rotation((2, twist)))))
        second = [s.axes for s in one.robot.inverse_all(other, [0.0] * len(one.mechanism.joints))]
        assert [a is None for a in first] == [a is None for a in second]
        for one_axes, other_axes in zip(first, second, strict=True):
            if one_axes is not None and other_axes is not None:
                assert_allclose(one_axes, other_axes, rtol=0.0, atol=_SAME * max(one.size, 180.0))


@pytest.mark.parametrize("name", ["3-RPS on a raised base", "Z3 head with slides"])
def test_the_parasitic_motion_is_the_published_one(name: str) -> None:
    """Planes through the axis at 0, 120 and 240 degrees: r21 = r12, x = r (r11 - r22) / 2 and y = -r r21."""
    one = guided(name)
    for frame in commands(one, 12, seed=3):
        for solution in one.robot.inverse_all(frame, [0.0] * 3):
            if solution.axes is None:
                continue
            start = softkin.Frame((0.0, 0.0, frame.position[2]), _untwisted(one, frame))
            (x, y, _), r = one.robot.forward(solution.axes, start)[0]  # type: ignore[call-arg]
            radius = one.robot.parameters["plate_radius"]
            assert r[1][0] == pytest.approx(r[0][1], abs=1e-9)
            assert x == pytest.approx(radius * (r[0][0] - r[1][1]) / 2, abs=1e-7)
            assert y == pytest.approx(-radius * r[1][0], abs=1e-7)


@EVERY
@pytest.mark.parametrize("base", (None, BASE), ids=("bare", "on an inclined base"))
def test_every_row_is_the_slope_of_forward_kinematics(name: str, base: softkin.Frame | None) -> None:
    """By central differences. On an inclined base the commanded coordinates move with those that are not."""
    one, measured = guided(name), 0
    robot = one.robot if base is None else one.robot.with_base(base)
    for frame in commands(one, 12, seed=5, size=0.5):
        for solution in one.robot.inverse_all(frame, [0.0] * len(one.mechanism.joints)):
            axes = np.array(solution.axes or [np.nan] * len(one.mechanism.joints))
            margins = one.robot.singularity(axes).margins.values()  # not numbers where forward kinematics has no pose
            if not all(abs(v) >= 0.1 for v in margins):
                continue
            expected = rows_of(robot, axes, one.size)
            assert_allclose(matrix_of(robot, axes), expected, rtol=0.0, atol=1e-6 * np.abs(expected).max())
            measured += 1
    assert measured > 2


@EVERY
def test_both_languages_say_the_same(name: str) -> None:
    """At poses far beyond reach as well, and with far references."""
    one, answered = guided(name), 0
    for number, frame in enumerate([*commands(one, _FEW), *commands(one, 4, size=3.0)]):
        reference = [(-1.0) ** k * (900.0 if number % 2 else 0.0) for k in range(len(one.mechanism.joints))]
        for axes in inverse_in_both(one.controller, one.robot, frame, reference, _SAME * max(one.size, 180.0)):
            answered += 1
            forward_in_both(one.controller, one.robot, axes, 10.0 * one.size, _SAME)
    assert answered > 5


@EVERY
def test_batches_are_the_same(name: str) -> None:
    one = guided(name)
    frames = commands(one, 30, seed=13, size=1.5)
    configuration = tuple(1 for _ in range(one.robot.BRANCHES)) + (0,) * len(one.robot.PERIOD_AXES)
    zero = [0.0] * len(one.mechanism.joints)
    positions, rotations = np.array([f.position for f in frames]), np.array([f.rotation for f in frames])
    axes, statuses = one.robot.inverse_batch(positions, rotations, configuration, zero)
    for frame, row, status in zip(frames, axes, statuses, strict=True):
        try:
            found = one.robot.inverse(frame, configuration, zero)
        except KinematicsError as refused:
            assert refused.status is Status(status)
            continue
        assert status == Status.OK
        assert_allclose(row, found, rtol=0.0, atol=_SAME * max(one.size, 180.0))


@pytest.mark.parametrize("name", TILTING)
def test_singular_poses_are_answered_or_refused(name: str) -> None:
    """Level, tilted by quarter turns, and upside down: both languages agree, and what is answered closes."""
    one, reached = guided(name), 0
    position, zeros = home_of(one)[0], [0.0] * len(one.mechanism.joints)
    for about in (0, 1):
        for quarter in (0, 1, 2, 3):
            for twist in (0.0, 1.0, np.pi):
                rows = rotation((about, quarter * np.pi / 2), (2, twist))
                frame = softkin.Frame(tuple(position), tuple(map(tuple, rows)))
                for axes in inverse_in_both(one.controller, one.robot, frame, zeros, 1e-6 * one.size):
                    reached += 1
                    if quarter == 0:
                        assert residual(one, np.array(axes), one.robot.forward(axes)[0]) < _CLOSED
                    assert quarter != 2 or "T" in name, "upside down radial planes do not hold the twist"
    assert reached >= 6


def test_near_the_other_twist_the_margin_tells_it() -> None:
    """The margin of radial guides is a multiple of 1 + r33: it goes to zero where the tool turns upside down."""
    one = guided("3-RPS on a raised base")
    assert "guides_dependent" in one.robot.singularity([450.0, 450.0, 450.0]).margins
    last, first = np.inf, abs(one.robot.singularity([452.0, 454.0, 456.0]).margins["guides_dependent"]) / 2
    for degrees in (0.0, 15.0, 30.0, 45.0):
        frame = softkin.Frame((0.0, 0.0, 450.0), tuple(map(tuple, rotation((0, np.radians(degrees))))))
        axes = one.robot.inverse(frame, (), [0.0] * 3)
        start = softkin.Frame((0.0, 0.0, 450.0), frame.rotation)
        assert residual(one, np.array(axes), one.robot.forward(axes, start)[0]) < _CLOSED  # type: ignore[call-arg]
        margin = abs(one.robot.singularity(axes).margins["guides_dependent"])
        assert margin < last
        assert margin == pytest.approx(first * (1 + np.cos(np.radians(degrees))), rel=1e-9)
        last = margin


def test_a_refused_pose_is_told_by_its_twist_or_leg() -> None:
    one = guided("Z3 head with slides")
    upside_down = softkin.Frame((0.0, 0.0, 0.0), tuple(map(tuple, rotation((0, np.pi)))))
    assert refusal(one.robot.inverse, upside_down, (1, 1, 1), [0.0] * 3) is Status.UNREACHABLE
    status, _ = one.controller.inverse(upside_down.position, upside_down.rotation, (1, 1, 1), [0.0] * 3)
    assert status == UNREACHABLE
