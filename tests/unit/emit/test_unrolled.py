"""All branches at once: `inverse_all`, `branches`, `branch` and batches against the branches one by one."""

import copy
import pickle

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Mechanism, Solution, Status, _batch
from softkin._batch import CHUNK
from softkin._configuration import slots
from softkin._start import IterativeForward

from derive.description.mechanism import Mechanism as Description
from tests.mechanisms import catalogue
from tests.random_axes import random_axes

DESCRIPTIONS = [m for _, m in catalogue() if not m.is_orientation or m.joints]
IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
Frames = list[tuple[tuple[float, ...], tuple[tuple[float, ...], ...]]]


def robot_of(
    description: Description, limit: float | None = None, offset: float = 0.0, check_limits: bool = True
) -> Mechanism:
    """A machine of the description's own dimensions; the limits are those of every axis that turns."""
    values: dict[str, float] = {p.name: p.nominal for p in description.parameters}
    values |= {joint.offset.name: offset * k for k, joint in enumerate(description.joints, 1)}
    if limit is not None:
        for joint in description.joints:
            if joint.axis_is_angle and joint.pitch == 0:
                values |= {f"lower_{joint.key}": -0.7 * limit, f"upper_{joint.key}": limit}
    return softkin.catalogue()[description.name](**values, check_limits=check_limits)


def samples(robot: Mechanism, count: int) -> tuple[Frames, np.ndarray]:
    """Frames of random axes, every third drawn away from the machine, and random references."""
    random = np.random.default_rng(8)
    frames: Frames = []
    while len(frames) < count:
        try:
            (position, rotation), _ = robot.forward(random_axes(robot, 1, random, slide=90.0)[0])
        except KinematicsError:
            position, rotation = tuple((random.uniform(-1, 1, 3) * _around(robot)).tolist()), IDENTITY
        far = 1.4 if len(frames) % 3 == 0 else 1.0
        frames.append((tuple(far * c for c in position), rotation))
    return frames, random_axes(robot, count, random, 340.0, 180.0)


def _around(robot: Mechanism) -> np.ndarray:
    """Where a machine may be that is nowhere at random axes: in its plane, and near the home of one that iterates."""
    size = 60.0 if isinstance(robot, IterativeForward) and robot.BRANCHES else 300.0
    return np.array([size, size, size if "z" in robot.JACOBIAN_ROWS or size == 300.0 else 0.0])


def looped(robot: Mechanism, frame: tuple[object, ...], reference: tuple[float, ...]) -> tuple[object, ...]:
    position, rotation = robot._pose(frame)  # type: ignore[arg-type]
    return Mechanism._every_branch(robot, position, rotation, reference)


def compare(robot: Mechanism, frame: tuple[object, ...], reference: tuple[float, ...]) -> int:
    """`inverse_all` answers as the branches one by one do; the number of answers."""
    solutions = robot.inverse_all(frame, reference)  # type: ignore[arg-type]
    for found, axes in zip(solutions, looped(robot, frame, reference), strict=True):
        assert (found.axes is None) == isinstance(axes, int)
        assert axes == (float(found.status) if found.axes is None else pytest.approx(found.axes, rel=1e-9, abs=1e-9))
    return sum(found.axes is not None for found in solutions)


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("limit", [None, 120.0, 330.0], ids=["no limits", "limits", "more than a turn"])
@pytest.mark.parametrize("description", DESCRIPTIONS, ids=lambda d: d.name)
def test_inverse_all_is_its_branches_one_by_one(description: Description, limit: float | None) -> None:
    robot = robot_of(description, limit)
    frames, references = samples(robot, 12 if description.search is not None else 24)
    pairs = zip(frames, references.tolist(), strict=True)
    assert sum(compare(robot, frame, tuple(reference)) for frame, reference in pairs) >= 3


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("description", DESCRIPTIONS, ids=lambda d: d.name)
def test_inverse_all_without_its_limits_answers_what_is_beyond_them(description: Description) -> None:
    """Limits that are not tested still say which turn an axis takes, where one value is inside."""
    robot = robot_of(description, 20.0, check_limits=False)
    frames, references = samples(robot, 3 if description.search is not None else 15)
    for frame, reference in zip(frames, references.tolist(), strict=True):
        compare(robot, frame, tuple(reference))


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -2e9])
@pytest.mark.parametrize("description", DESCRIPTIONS, ids=lambda d: d.name)
def test_inverse_all_of_numbers_that_are_none_is_its_branches_one_by_one(
    description: Description, value: float
) -> None:
    """In every place of position and reference: what a program does not read does no harm."""
    robot = robot_of(description)
    (_, frame), _ = samples(robot, 2)
    position, count = frame[0], len(robot.AXES)
    near = [((value,) * count)] + [tuple(value if i == k else 0.0 for i in range(count)) for k in range(count)]
    spoiled = [(tuple(value if i == k else c for i, c in enumerate(position)), frame[1]) for k in range(3)]
    for asked, reference in [*((s, (0.0,) * count) for s in spoiled), *((frame, reference) for reference in near)]:
        compare(robot, asked, reference)


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("offset", [0.0, 7.0], ids=["no offsets", "offsets"])
@pytest.mark.parametrize("description", DESCRIPTIONS, ids=lambda d: d.name)
def test_trusted_input_gives_the_same_directions(description: Description, offset: float) -> None:
    """Axes differ by whole turns at most, and only where no other axis moves with them; the frame is the same."""
    robot = robot_of(description, offset=offset)
    frames, references = samples(robot, 4 if description.search is not None else 30)
    every = slots((0,) * robot.BRANCHES)
    answers = 0
    for frame, reference in zip(frames, references.tolist(), strict=True):
        solutions, near = robot.inverse_all(frame, reference), tuple(reference)
        directions = robot.branches(frame, near)  # type: ignore[arg-type]
        for (_, signs), axes, solution in zip(every, directions, solutions, strict=True):
            single = robot.branch(frame, signs, near)  # type: ignore[arg-type]
            assert (axes is None) == (single is None) == (solution.axes is None)
            if axes is not None and single is not None and solution.axes is not None:
                answers += 1
                check_same(description, robot, axes, solution.axes)
                check_same(description, robot, single, solution.axes)
    assert answers >= 3


def check_same(description: Description, robot: Mechanism, found: tuple[float, ...], wanted: tuple[float, ...]) -> None:
    driving = {s for joint in description.joints for s in joint.coupling.free_symbols}
    for axis, joint, value, near in zip(robot.AXES, description.joints, found, wanted, strict=True):
        is_open = axis.multi_turn and joint.motor not in driving and joint.symbol not in driving
        assert abs((value - near + 180.0) % 360.0 - 180.0 if is_open else value - near) < 1e-8
    if isinstance(robot, IterativeForward) and robot.BRANCHES:
        return  # whose joints turn whole turns at most
    (place, rotation), (right, turned) = robot.forward(found)[0], robot.forward(wanted)[0]
    assert place == pytest.approx(right, rel=1e-9, abs=1e-7)
    np.testing.assert_allclose(rotation, turned, atol=1e-9)


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("description", DESCRIPTIONS, ids=lambda d: d.name)
def test_a_batch_of_all_branches_is_its_rows(description: Description) -> None:
    robot = robot_of(description, 120.0)
    frames, references = samples(robot, 12 if description.search is not None else 24)
    positions, rotations = np.array([f[0] for f in frames]), np.array([f[1] for f in frames])
    positions[5] = np.nan
    axes, statuses = robot.inverse_all_batch(positions, rotations, references)
    assert axes.shape == (len(frames), 2**robot.BRANCHES, len(robot.AXES))
    for row, frame in enumerate(zip(positions, rotations, strict=True)):
        for slot, solution in enumerate(robot.inverse_all(frame, references[row])):
            assert statuses[row, slot] == solution.status
            if solution.axes is None:
                assert np.all(np.isnan(axes[row, slot]))
            else:
                assert axes[row, slot] == pytest.approx(solution.axes, rel=1e-9, abs=1e-9)


@pytest.mark.long("Hexapod")
@pytest.mark.parametrize("description", DESCRIPTIONS, ids=lambda d: d.name)
def test_all_branches_of_a_row_are_the_same_in_any_company(
    description: Description, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Poses at right angles, many of them singular, between others and garbage, bit for bit; chunks of a few rows."""
    robot = robot_of(description)
    random, count = np.random.default_rng(4), 4 if description.search is not None else 24
    spans = np.array([90.0 if axis.unit == "deg" else 40.0 for axis in robot.AXES])
    axes = random.integers(-2, 3, (count, len(spans))) * spans
    positions, rotations, _, statuses = robot.forward_batch(axes)
    (frames, _), others = samples(robot, count), (statuses != Status.OK) | (np.arange(count) % 3 == 2)
    for row in np.flatnonzero(others):
        positions[row], rotations[row] = frames[row]
    positions[1::11] = np.nan
    whole = robot.inverse_all_batch(positions, rotations, axes)
    monkeypatch.setattr(_batch, "EVERY_SLOT", 5 * 2**robot.BRANCHES)
    parts = robot.inverse_all_batch(positions, rotations, axes)
    assert all(np.array_equal(one, other, equal_nan=True) for one, other in zip(whole, parts, strict=True))
    for row in range(count):
        alone = robot.inverse_all_batch(positions[[row]], rotations[[row]], axes[[row]])
        assert np.array_equal(alone[1][0], whole[1][row])
        np.testing.assert_allclose(alone[0][0], whole[0][row], rtol=1e-12, atol=1e-12)
    assert (whole[1] == Status.OK).any()


@pytest.mark.parametrize("name", ["Kin_ArticulatedRobot_6DOF", "Kin_Delta_P3C_Type3"])
def test_rows_in_chunks_are_the_rows_alone(name: str) -> None:
    """Open and named branches mixed, across the edge of a chunk; one row there is refused, one is singular."""
    description = next(d for d in DESCRIPTIONS if d.name == name)
    robot = robot_of(description)
    frames, references = samples(robot, 70)
    rows = np.arange(CHUNK + 40) % 70
    positions, rotations = np.array([f[0] for f in frames])[rows], np.array([f[1] for f in frames])[rows]
    configurations = np.zeros((len(rows), len(robot.CONFIGURATION)), int)
    configurations[:, : robot.BRANCHES] = np.random.default_rng(2).integers(0, 4, (len(rows), robot.BRANCHES))
    positions[CHUNK - 1] = np.inf
    axes, statuses = robot.inverse_batch(positions, rotations, configurations, references[rows])
    assert statuses[CHUNK - 1] == Status.BAD_INPUT
    for row in (*range(40), *range(CHUNK - 20, CHUNK + 40)):
        alone, status = robot.inverse_batch(
            positions[[row]], rotations[[row]], configurations[[row]], references[rows[[row]]]
        )
        assert status[0] == statuses[row]
        np.testing.assert_allclose(axes[row], alone[0], rtol=1e-12, atol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("name", ["Kin_ArticulatedRobot_6DOF", "Kin_Ac6_RZRYRYRXRYRZ_J6Offset"])
def test_trusted_calls_can_be_sent_to_another_process(name: str) -> None:
    robot = robot_of(next(d for d in DESCRIPTIONS if d.name == name))
    (_, frame), _ = samples(robot, 2)  # the first is out of reach
    plain, signs, zeros = (tuple(frame[0]), frame[1]), (1.0,) * robot.BRANCHES, (0.0,) * 6
    branches, branch = (pickle.loads(pickle.dumps(call)) for call in (robot.branches, robot.branch))
    assert any(axes is not None for axes in robot.branches(plain))  # type: ignore[arg-type]
    assert branches(plain) == robot.branches(plain, zeros) == robot.branches(plain)  # type: ignore[arg-type]
    one = robot.branch(plain, signs, zeros)  # type: ignore[arg-type]
    assert branch(plain, signs) == one == robot.branch(plain, signs, None)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["Kin_Ac6_ThreeParallel", "Kin_ArticulatedRobot_6DOF"])
@pytest.mark.parametrize("value", [float("nan"), float("inf"), -1e300, 1e154])
def test_trusted_calls_do_not_raise_for_what_is_no_pose(name: str, value: float) -> None:
    robot = robot_of(next(d for d in DESCRIPTIONS if d.name == name))
    for place in range(3):
        position = tuple(value if i == place else 300.0 for i in range(3))
        robot.branches((position, IDENTITY))  # type: ignore[arg-type]


def test_the_solutions_are_as_a_tuple_of_them() -> None:
    robot = robot_of(next(d for d in DESCRIPTIONS if d.name == "Kin_ArticulatedRobot_6DOF"))
    (frame,), _ = samples(robot, 1)
    found = robot.inverse_all(frame)
    plain = tuple(found)
    assert len(found) == 8 and all(isinstance(s, Solution) for s in plain)
    assert found == plain and plain == found and found == robot.inverse_all(frame)
    assert found != list(plain) and found != plain[:7]
    assert hash(found) == hash(plain) and repr(found) == repr(plain)
    assert found[0] == plain[0] and found[-1] == plain[-1] and found[2:5] == plain[2:5]
    assert (
        plain[3] in found
        and found.index(plain[3]) == plain.index(plain[3])
        and list(reversed(found)) == list(reversed(plain))
    )
    assert copy.deepcopy(found) == plain and pickle.loads(pickle.dumps(found)) == plain
    with pytest.raises(IndexError):
        found[8]
