"""More rods than hold a point or a platform, and cables that only pull: lengths are distances, the pose of a length is
found by Newton's method of NumPy on all rods, tensions by linear programming."""

from functools import cache
from itertools import combinations

import numpy as np
import pytest
import softkin
from numpy.testing import assert_allclose
from scipy.optimize import linprog
from softkin import KinematicsError, Status

from derive.description.mechanism import DescriptionError, Mechanism
from derive.description.validate import validate
from derive.kinematics.solution import prepared
from derive.mechanism import Task, X, Y, linear, rod
from tests.machines.both import forward_in_both, in_both, inverse_in_both
from tests.machines.made import Array, built_of, imported_class
from tests.machines.surplus_machines import FOUR, LOADED, PLATFORMS, POINTS, THREE, Point, at_points
from tests.orthonormal import rodrigues
from tests.text.controller import IMPOSSIBLE, OK, Controller

pytestmark = pytest.mark.slow

_FEW, _AROUND, _STEP = 12, 0.1, 1e-3
_EYE = np.eye(3)


@cache
def point_machine(name: str) -> tuple[softkin.Mechanism, Controller]:
    return in_both(validate({**POINTS, **LOADED}[name][0]), {"offset_l2": 12.5})[1:]


@cache
def platform(name: str) -> softkin.Mechanism:
    mechanism = validate(PLATFORMS[name][0])
    return imported_class(mechanism, built_of(mechanism))()


def points_around(anchors: tuple[Point, ...], middle: Point, count: int = _FEW, share: float = _AROUND) -> Array:
    """Points around the middle of the workspace, in three coordinates."""
    size = np.ptp(np.array(anchors), axis=0).max()
    drawn = np.array(middle) + share * size * np.random.default_rng(5).uniform(-1.0, 1.0, (count, len(middle)))
    return np.pad(drawn, ((0, 0), (0, 3 - drawn.shape[1])))


def distances(anchors: tuple[Point, ...], point: Array) -> Array:
    return np.asarray(np.linalg.norm(point[: len(anchors[0])] - np.array(anchors), axis=1))


def axes_of(anchors: tuple[Point, ...], point: Array) -> tuple[float, ...]:
    """The axis values at a point: the distances, and the offset of the second axis."""
    return tuple(distances(anchors, point) + 12.5 * (np.arange(len(anchors)) == 1))


def nearest_point(anchors: tuple[Point, ...], lengths: Array, start: Array, rods: tuple[int, ...]) -> Array:
    """The point with these lengths of some rods, by Newton's method from a start."""
    place = start[: len(anchors[0])].copy()
    fixed = np.array(anchors)[list(rods)]
    for _ in range(50):
        span = place - fixed
        away = np.linalg.norm(span, axis=1)
        place -= np.linalg.lstsq(span / away[:, None], away - lengths[list(rods)], rcond=None)[0]
    return np.pad(place, (0, 3 - len(place)))


@pytest.mark.parametrize("name", POINTS)
def test_every_length_is_a_distance_and_leads_back(name: str) -> None:
    _, anchors, middle = POINTS[name]
    robot, controller = point_machine(name)
    for point in points_around(anchors, middle):
        axes = axes_of(anchors, point)
        frame = softkin.Frame(tuple(point.tolist()), tuple(map(tuple, _EYE.tolist())))
        found = inverse_in_both(controller, robot, frame, axes)
        assert len(found) == 1  # one solution: lengths are positive
        assert_allclose(found[0], axes, rtol=1e-12)
        answer = forward_in_both(controller, robot, axes, 1000.0)
        assert answer is not None
        assert_allclose(answer[0].position, point, atol=1e-9 * 1000.0)
        every = tuple(range(len(anchors)))
        assert_allclose(nearest_point(anchors, distances(anchors, point), point + 3.0, every), point, atol=1e-8)


@pytest.mark.parametrize("name", POINTS)
def test_the_surplus_rod_is_the_one_without_which_the_others_hold_best(name: str) -> None:
    mechanism, anchors, _ = POINTS[name]
    robot, _ = point_machine(name)
    lengths, best = np.array([j.nominal for j in mechanism.joints]), None
    starts = np.array(anchors).mean(axis=0) + 100.0 * np.array([*np.eye(len(anchors[0])), *-np.eye(len(anchors[0]))])
    every = tuple(range(len(anchors)))
    for start in starts:
        point = nearest_point(anchors, lengths, start, every)[: len(anchors[0])]
        missed = np.linalg.norm(distances(anchors, point) - lengths)
        best = min(best or (np.inf, point), (missed, point), key=lambda one: one[0])
    assert best is not None
    lines = best[1] - np.array(anchors)
    lines /= np.linalg.norm(lines, axis=1)[:, None]
    held = {rods: abs(np.linalg.det(lines[list(rods)])) for rods in combinations(every, len(anchors[0]))}
    (left,) = set(every) - set(max(held, key=lambda rods: held[rods]))
    assert (left,) == robot.SURPLUS


@pytest.mark.parametrize("name", POINTS)
def test_by_how_much_a_rod_misses(name: str) -> None:
    """A thousandth of its length is refused, and less is not; `max_miss` moves that, and forward kinematics then takes
    the pose of the others."""
    _, anchors, middle = POINTS[name]
    robot, controller = point_machine(name)
    (surplus,), point = robot.SURPLUS, points_around(anchors, middle)[0]
    axes, start = np.array(axes_of(anchors, point)), point + 1.0
    length = distances(anchors, point)[surplus]
    longer = axes + 3.0 * (np.arange(len(axes)) == surplus)
    for one in (robot, robot.in_radians(), robot.with_base(((1.0, 2.0, 3.0 * (len(anchors[0]) > 2)), _EYE))):
        assert one.misses(longer) == pytest.approx({robot.AXES[surplus].name: -3.0})
    holding = tuple(k for k in range(len(anchors)) if k != surplus)
    for axis in range(len(anchors)):
        for share in (-1.5e-3, 2e-4, 1.5e-3):
            moved = axes.copy()
            moved[axis] += share * length
            lengths = distances(anchors, point) + moved - axes
            place = nearest_point(anchors, lengths, start, holding)
            miss = distances(anchors, place)[surplus] - lengths[surplus]
            assert robot.misses(moved) == pytest.approx({robot.AXES[surplus].name: miss}, abs=1e-8)
            status, _ = controller.forward(moved)
            is_refused = abs(miss) > 1e-3 * lengths[surplus]
            assert status == (IMPOSSIBLE if is_refused else OK)
            if is_refused:
                with pytest.raises(KinematicsError, match=rf"{robot.AXES[surplus].name} is [-+][\d.e-]+ too short"):
                    robot.forward(moved)
            loose = type(robot)(**{**robot.parameters, "max_miss": 2.0 * length})
            assert_allclose(loose.forward(moved)[0].position, place, atol=1e-7)


@pytest.mark.parametrize("name", POINTS)
def test_all_axes_move_with_the_point(name: str) -> None:
    """Velocities and accelerations of the surplus axis, too, against differences of distances."""
    _, anchors, middle = POINTS[name]
    robot, controller = point_machine(name)
    point, width = points_around(anchors, middle)[1], len(anchors[0])
    axes, way = axes_of(anchors, point), np.array([30.0, -20.0, 10.0])[:width]
    twist = (*way, *[0.0] * len(robot.SURPLUS))
    assert (*"xyz"[:width], f"miss l{robot.SURPLUS[0] + 1}") == robot.JACOBIAN_ROWS
    step = np.pad(way, (0, 3 - width)) * _STEP
    ahead, behind, here = (distances(anchors, point + k * step) for k in (1, -1, 0))
    speeds = robot.axis_velocities(axes, twist)
    assert_allclose(speeds, (ahead - behind) / (2 * _STEP), rtol=1e-6)
    rates = robot.axis_accelerations(axes, speeds, [0.0] * len(twist))
    assert_allclose(rates, (ahead + behind - 2 * here) / _STEP**2, rtol=1e-3)
    assert_allclose(robot.twist(axes, speeds), twist, atol=1e-9)
    status, rows = controller.jacobian(axes)
    assert status == OK
    found = np.array(robot.jacobian(axes))
    assert_allclose(np.array(rows)[: len(found), : len(axes)], found, atol=1e-12)


def test_stated_surplus_rods_are_taken() -> None:
    five = (*FOUR, (1500.0, -1400.0, 2300.0))
    mechanism = prepared(validate(at_points("FiveLines", five, (2000.0,) * 5, 2, 4)))
    assert [joint.name for joint in mechanism.surplus] == ["L2", "L4"]
    assert [rod.name for rod in mechanism.holding_rods] == ["1", "3", "5"]


def turned(angles: Array) -> Array:
    return np.asarray(rodrigues(_EYE[2], angles[2]) @ rodrigues(_EYE[1], angles[1]) @ rodrigues(_EYE[0], angles[0]))


def lengths_on(name: str, position: Array, rotation: Array) -> Array:
    bases, plates = (np.array([[*p, 0.0][:3] for p in ends]) for ends in PLATFORMS[name][1])
    return np.asarray(np.linalg.norm(position + plates @ rotation.T - bases, axis=1))


@pytest.mark.parametrize("name", PLATFORMS)
def test_a_platform_on_more_cables_than_it_needs(name: str) -> None:
    robot, is_flat = platform(name), len(PLATFORMS[name][0].home) == 3
    free = np.array([1, 1, 0, 0, 0, 1]) if is_flat else np.ones(6)
    for motion in np.random.default_rng(3).uniform(-1.0, 1.0, (_FEW, 6)) * free:
        position = 150.0 * motion[:3] + (0.0 if is_flat else np.array([0.0, 0.0, 1200.0]))
        rotation = turned(0.2 * motion[3:])
        lengths = lengths_on(name, position, rotation)
        (slot,) = robot.inverse_all((position, rotation), lengths)
        assert slot.axes is not None
        assert_allclose(slot.axes, lengths, rtol=1e-12)
        frame, _ = robot.forward(lengths)
        assert_allclose(frame.position, position, atol=1e-7)
        assert_allclose(frame.rotation, rotation, atol=1e-9)
        rates = np.random.default_rng(4).uniform(-1.0, 1.0, 6) * np.array([90.0] * 3 + [0.3] * 3) * free
        twist = [rate for rate, is_free in zip(rates, free, strict=True) if is_free] + [0.0] * len(robot.SURPLUS)

        def at(time: float, start: Array = position, way: Array = rates, turn: Array = rotation) -> Array:
            spin = np.linalg.norm(way[3:])
            return lengths_on(name, start + time * way[:3], rodrigues(way[3:] / spin, time * spin) @ turn)

        speeds = robot.axis_velocities(lengths, twist)
        assert_allclose(speeds, (at(_STEP) - at(-_STEP)) / (2 * _STEP), rtol=1e-5, atol=1e-5)
        found = robot.axis_accelerations(lengths, speeds, [0.0] * len(twist))
        assert_allclose(found, (at(_STEP) + at(-_STEP) - 2 * at(0.0)) / _STEP**2, rtol=1e-3, atol=1e-2)
        moved = np.array(lengths)
        moved[robot.SURPLUS[0]] *= 1.002
        with pytest.raises(KinematicsError, match="too short"):
            robot.forward(moved)


def pulls(anchors: tuple[Point, ...], point: Array, load: Array) -> Array | None:
    """Tensions that hold the load, none of them negative; None if there are none."""
    lines = point[: len(anchors[0])] - np.array(anchors)
    lines = lines / np.linalg.norm(lines, axis=1)[:, None]
    found = linprog(np.ones(len(lines)), A_eq=lines.T, b_eq=load, bounds=(0.0, None))
    return np.asarray(found.x) if found.status == 0 else None


@pytest.mark.parametrize("name", LOADED)
def test_a_pose_at_which_a_cable_would_push_is_refused(name: str) -> None:
    """With the load down the pose is answered where linear programming finds tensions, and nowhere else; without a load
    everywhere."""
    _, anchors, middle = LOADED[name]
    robot, controller = point_machine(name)
    width, verdicts = len(middle), set()
    load = np.array([0.0] * (width - 1) + [-1.0])
    free = type(robot)(**{**robot.parameters, f"load_{'xyz'[width - 1]}": 0.0})
    for point in points_around(anchors, middle, 60, 0.7):
        axes = axes_of(anchors, point)
        without = free.diagnose((point, _EYE), (), axes)
        if without.status is not Status.OK:
            continue  # beyond the singularity of the rods that hold the point
        found = robot.diagnose((point, _EYE), (), axes)
        holds = pulls(anchors, point, load) is not None
        assert (found.status is Status.OK) is holds, point
        verdicts.add(holds)
        reason, missing = controller.diagnose(point, _EYE, (), axes)
        assert reason == found.reason
        assert missing == pytest.approx(found.missing, rel=1e-9, abs=1e-12)
        if not holds and len(anchors) == width:
            lines = np.subtract(point[:width], anchors)
            tensions = np.linalg.solve((lines / np.linalg.norm(lines, axis=1)[:, None]).T, load)
            least = int(np.argmin(tensions))
            assert found.reason == f"cable {least + 1}: it would have to push, by this share of the load"
            assert found.missing == pytest.approx(-tensions[least], rel=1e-9)
    assert verdicts == {True, False}


def _arm_and_rods() -> Mechanism:
    axes = tuple(linear(f"L{k}", f"Length {k}", nominal=500.0) for k in (1, 2, 3))
    ends = ((0, 0), (600, 0), (axes[2], 700))
    rods = tuple(rod(str(k), end, (X, Y), axis) for k, (end, axis) in enumerate(zip(ends, axes, strict=True), 1))
    return Mechanism(name="Slid", joints=axes, rods=rods, surplus=axes[2:], task=Task("xy"))


@pytest.mark.parametrize(
    ("mechanism", "sentence"),
    [
        (_arm_and_rods(), "surplus joint 'L3' must be the length of one rod without cones, and occur nowhere else"),
        (at_points("Few", THREE, (2600.0,) * 3, 1), "there are only 3 joints"),
    ],
)
def test_what_is_no_surplus_rod_is_refused(mechanism: Mechanism, sentence: str) -> None:
    with pytest.raises(DescriptionError, match=sentence):
        prepared(validate(mechanism))
