"""No solution is lost at common poses: near A4 = 0 and 180 degrees and near a straight elbow, and on paths there."""

from itertools import product

import numpy as np
import pytest
import softkin
from softkin import Status

from derive.mechanisms.kin_ac6_rzryryrxryrz_j6offset import MECHANISM
from tests.catalogue.both_ways import missed
from tests.catalogue.search.arms import Array
from tests.catalogue.search.planted import ARM, KINDS, OFFSETS, planted
from tests.catalogue.shares import MOST_SEARCHED, share
from tests.text.controller import OK, Controller
from tests.text.units import compiled

pytestmark = pytest.mark.slow

STRAIGHT = float(np.degrees(np.arctan2(ARM["d4"], -ARM["a3"])))
REGULAR = 1e-3
"""Where the smallest singular value of the scaled Jacobian is larger, a pose is regular."""


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("lateral", OFFSETS)
def test_planted_poses(kind: str, lateral: float) -> None:
    """Of many where the search is difficult, and of some anywhere."""
    case = planted(kind, lateral, 60 if kind == "anywhere" else 1800, 12)
    places, turns = missed_of_a_share(case.robot, case.axes, case.references)
    assert places < 1e-6 and turns < 1e-9


def missed_of_a_share(robot: softkin.Mechanism, axes: Array, references: Array) -> tuple[float, float]:
    """`missed`, of the rows that this core is asked."""
    asked = share(len(axes), MOST_SEARCHED)
    return missed(robot, axes[asked], references[asked])


LOST = {
    1e-6: (
        (20.680794604651624, 76.57934454864488, 94.7636416907313, 107.1833586205289, 16.626697271521323, 136.689562521),
        (26.48570533757851, 89.47374945542157, 94.76364166896298, 157.170767660695, -90.00073747891325, -156.443133084),
    ),
    60.0: ((180.0, 0.0, -90.0, 180.0, 0.0, 0.0),),
    150.0: (
        (101.003055, -155.763074, 94.76272379750108, -19.795488, -77.784248, -12.027807),
        (
            -15.917461476755477,
            7.477319877444728,
            94.78352380036634,
            8.419675022612154,
            -58.19733256469311,
            137.309398524,
        ),
    ),
    -300.0: (
        (-33.66869272827205, -148.92608485920607, 94.80437491638847, -31.24743988, 23.7631743457, -160.16310682181964),
        (
            102.38847764684363,
            -175.14384556208714,
            94.76364659324585,
            -6.650570097147176e-11,
            64.26025663,
            -109.14666664,
        ),
    ),
}
"""Poses that were lost: two solutions are nearly one. Values of a residual show neither, or its rounding hides both."""


@pytest.mark.parametrize(("lateral", "axes"), [(lateral, axes) for lateral, poses in LOST.items() for axes in poses])
@pytest.mark.parametrize("turned", (0.0, 0.5, 1.7, 3.1, 4.4, 90.0))
def test_poses_that_were_lost(lateral: float, axes: tuple[float, ...], turned: float) -> None:
    """The search begins elsewhere with every reference."""
    robot = softkin.Ac6RZRYRYRXRYRZJ6Offset(**ARM, j6_offset_x=lateral)
    frame, configuration = robot.forward(axes)
    for reference in ((0.0,) * 5 + (turned,), (*axes[:5], axes[5] + turned)):
        answer = robot.inverse(frame, configuration, reference)
        assert np.abs(np.subtract(robot.forward(answer)[0].position, frame.position)).max() < 1e-6
        _, statuses = robot.inverse_batch([frame.position], [frame.rotation], configuration, [reference])
        assert statuses.tolist() == [Status.OK]


FOLDED = {**ARM, "a1": 0.0, "a3": 0.0, "d4": ARM["a2"], "d6": 0.0}
"""The folded elbow puts the wrist on axes 1 and 2."""


@pytest.mark.parametrize("lateral", (1e-3, 60.0, -300.0))
@pytest.mark.parametrize("unit", (1.0, 1e-3))
@pytest.mark.parametrize("lengths", (FOLDED, {**ARM, "a1": 0.0, "a3": 0.0}))
def test_a_folded_elbow_puts_the_wrist_on_the_first_axes(
    lateral: float, unit: float, lengths: dict[str, float]
) -> None:
    """Right angles, and elbows next to folded and stretched: axes 1 and 2 turn fast there, or are free."""
    rng = np.random.default_rng(19)
    near = planted("elbow", lateral, 36, 20).axes
    near[:, 2] += 90.0 - STRAIGHT
    axes = np.concatenate([rng.choice((-90.0, 0.0, 90.0, 180.0), (36, 6)), near])
    robot = softkin.Ac6RZRYRYRXRYRZJ6Offset(**{k: v * unit for k, v in lengths.items()}, j6_offset_x=lateral * unit)
    references = np.concatenate([axes, np.zeros_like(axes), rng.uniform(-180.0, 180.0, axes.shape)])
    places, turns = missed_of_a_share(robot, np.tile(axes, (3, 1)), references)
    assert places < 1e-6 * unit and turns < 1e-9


def test_the_block_answers_planted_poses_as_python_does() -> None:
    rng = np.random.default_rng(13)
    for kind, lateral in product(KINDS[1:], OFFSETS):
        case = planted(kind, lateral, 27, int(rng.integers(1e6)))
        block = Controller(compiled(MECHANISM), MECHANISM)
        assert block.initialise({**ARM, "j6_offset_x": lateral}) == OK
        for axes, reference in zip(case.axes, case.references, strict=True):
            frame, configuration = case.robot.forward(tuple(axes))
            status, answer = block.inverse(frame.position, frame.rotation, configuration, tuple(reference))
            assert status == OK, axes.tolist()
            reached = case.robot.forward(answer[:6])[0]
            assert np.abs(np.subtract(reached.position, frame.position)).max() < 1e-8
            assert np.abs(np.subtract(reached.rotation, frame.rotation)).max() < 1e-10
            if is_regular(case.robot, axes):
                expected = case.robot.inverse(frame, configuration, tuple(reference))
                assert np.abs(np.subtract(answer[:6], expected)).max() < 1e-6


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("lateral", (1e-3, 8.0, 60.0, -300.0))
def test_plain_numbers_and_batches_agree(kind: str, lateral: float) -> None:
    case = planted(kind, lateral, 12, 14)
    positions, rotations, configurations, _ = case.robot.forward_batch(case.axes)
    found, statuses = case.robot.inverse_batch(positions, rotations, configurations, case.references)
    assert (statuses == Status.OK).all()
    for k, axes in enumerate(case.axes):
        one = case.robot.inverse((positions[k], rotations[k]), configurations[k].tolist(), tuple(case.references[k]))
        if is_regular(case.robot, axes):
            assert np.abs(np.subtract(one, found[k])).max() < 1e-6


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("lateral", (8.0, 60.0, -300.0))
def test_nothing_is_missed_that_a_scan_finds(kind: str, lateral: float) -> None:
    case = planted(kind, lateral, 12, 15)
    frames = [case.robot.forward(tuple(axes))[0] for axes in case.axes]
    seen = 0
    for frame, roots in zip(frames, scanned(case.robot, frames), strict=True):
        found = [np.array(a) for s in case.robot.inverse_all(frame) if s.axes is not None for a in (s.axes, *s.others)]
        for root in roots:
            seen += 1
            assert min(abs(np.exp(1j * np.radians(s[5])) - np.exp(1j * root)) for s in found) < 1e-5
    assert seen > 30


def scanned(
    robot: softkin.Ac6RZRYRYRXRYRZJ6Offset, frames: list[softkin.Frame], trials: int = 6000
) -> list[list[float]]:
    """A6 (radians) at every simple root that changes the sign of the trial between neighbours of a scan, by frame."""
    joint = np.linspace(0.0, 2 * np.pi, trials + 1)
    goals = np.array([[*frame.position, *np.ravel(frame.rotation)] for frame in frames])
    starts = []
    for number, shoulder, side in product(range(len(frames)), (1.0, -1.0), (1.0, -1.0)):
        f, g = tried(robot, goals[number], shoulder, side, joint)
        is_smooth = np.abs(np.diff(f)) < 0.2  # more is a jump
        chosen = (f[:-1] * f[1:] < 0.0) & (g[:-1] > 1e-9) & (g[1:] > 1e-9) & is_smooth
        starts += [(number, shoulder, side, f[k], joint[k], joint[k + 1]) for k in np.flatnonzero(chosen)]
    owner, shoulders, sides, f, low, high = np.array(starts).reshape(-1, 6).T
    owner = owner.astype(int)
    for _ in range(60):
        middle = (low + high) / 2
        same = tried(robot, goals[owner].T, shoulders, sides, middle)[0] * f > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    left = np.abs(tried(robot, goals[owner].T, shoulders, sides, low)[0]) < 1e-10
    return [low[left & (owner == number)].tolist() for number in range(len(frames))]


def tried(
    robot: softkin.Ac6RZRYRYRXRYRZJ6Offset, goals: Array, shoulder: float | Array, side: float | Array, joint: Array
) -> tuple[Array, Array]:
    """The trial and its guard at values of the last joint (radians), of one goal or of one for each."""
    names = [*"xyz", *(f"r{i + 1}{j + 1}" for i, j in product(range(3), repeat=2))]
    given: dict[str, float | Array] = {f"goal_{n}": v for n, v in zip(names, goals, strict=True)}
    given |= {"reference_a1": 0.0, "reference_a2": 0.0, "rounds_before": 0, "tried": joint}
    given |= {"side": side, "wanted_elbow": 1.0, "wanted_shoulder": shoulder}
    values = tuple(given[name] for name in sorted(given))
    with np.errstate(all="ignore"):
        said = robot._array_programs().try_joint(values, np.zeros(len(joint), np.uint8))
    return np.asarray(said[0]), np.asarray(said[2])


def is_regular(robot: softkin.Ac6RZRYRYRXRYRZJ6Offset, axes: Array) -> bool:
    """By the smallest singular value of the Jacobian, lengths in those of the machine."""
    jacobian = np.array(robot.jacobian(tuple(axes)))
    jacobian[:3] /= ARM["a1"] + ARM["a2"] + ARM["d4"]
    return bool(np.linalg.svd(jacobian, compute_uv=False)[-1] > REGULAR)


@pytest.mark.parametrize("distance", (1e-3, 1e-6, 1e-9, 1e-12, 0.0))
def test_a_straight_wrist_is_regular(distance: float) -> None:
    rng = np.random.default_rng(16)
    axes = rng.uniform(-180.0, 180.0, (80, 6))
    axes[:, 3] = rng.choice((0.0, 180.0), 80) + distance
    robot = softkin.Ac6RZRYRYRXRYRZJ6Offset(**ARM, j6_offset_x=60.0)
    positions, rotations, configurations, _ = robot.forward_batch(axes)
    regular = np.array([is_regular(robot, a) for a in axes])
    for references in (axes, np.zeros_like(axes), rng.uniform(-180.0, 180.0, (80, 6))):
        assert (robot.inverse_batch(positions, rotations, configurations, references)[1] == Status.OK).all()
    found = robot.inverse_batch(positions, rotations, configurations, axes)[0]
    assert np.abs(found - axes)[regular].max() < 1e-6


def test_paths_through_a_straight_wrist_do_not_stop() -> None:
    """Some straight lines of joints through A4 = 0, every byte open but those of shoulder and elbow."""
    robot, rng = softkin.Ac6RZRYRYRXRYRZJ6Offset(**ARM, j6_offset_x=60.0), np.random.default_rng(17)
    followed = 0
    while followed < 10:
        middle = np.array([*rng.uniform(-120, 120, 3), 0.0, *rng.uniform(-120, 120, 2)])
        path = middle + np.linspace(-1.0, 1.0, 81)[:, None] * rng.uniform(-4, 4, 6)
        if not all(is_regular(robot, row) for row in path):
            continue
        axes = path[0]
        for expected in path:
            frame, configuration = robot.forward(tuple(expected))
            held = (*configuration[:2], 0, *configuration[3:4], *configuration[4:])
            axes = np.array(robot.inverse(frame, held, tuple(axes)))
            assert np.abs(axes - expected).max() < 1e-6
        followed += 1


@pytest.mark.parametrize("lateral", (60.0, -35.0))
@pytest.mark.parametrize("lengths", (ARM, {**ARM, "a1": 0.0, "a3": 0.0}, {k: v / 1000 for k, v in ARM.items()}))
def test_regular_poses_at_right_angles(lateral: float, lengths: dict[str, float]) -> None:
    """Regular poses with all joints at right angles are solved, in any unit of length."""
    lateral = lateral / 1000 if lengths["d1"] < 1 else lateral
    robot, rng = softkin.Ac6RZRYRYRXRYRZJ6Offset(**lengths, j6_offset_x=lateral), np.random.default_rng(18)
    grid = np.array(list(product((-90.0, 0.0, 90.0, 180.0), repeat=6)))
    axes = grid[rng.choice(len(grid), 600, replace=False)]
    jacobians = np.array([robot.jacobian(tuple(a)) for a in axes])
    jacobians[:, :3] /= lengths["a1"] + lengths["a2"] + lengths["d4"]
    axes = axes[np.linalg.svd(jacobians, compute_uv=False)[:, -1] > 1e-6]
    assert len(axes) > 100
    references = np.concatenate([axes, np.zeros_like(axes), rng.uniform(-180.0, 180.0, axes.shape)])
    places, turns = missed_of_a_share(robot, np.tile(axes, (3, 1)), references)
    assert places < 1e-9 * lengths["d1"] and turns < 1e-10


def test_a_free_first_axis_is_turned_to_where_the_pose_is_met() -> None:
    """The wrist on the first axis, which is free in a trial: at the reference, or half a turn on."""
    lengths, rng = {**ARM, "a1": 0.0, "a3": 0.0}, np.random.default_rng(20)
    robot = softkin.Ac6RZRYRYRXRYRZJ6Offset(**lengths, j6_offset_x=150.0)
    near = rng.choice((-1.0, 1.0), (800, 6)) * 10.0 ** rng.uniform(-13.0, -1.0, (800, 6))
    axes = 90.0 * rng.integers(-2, 3, (800, 6)) + np.where(rng.random((800, 6)) < 0.5, 0.0, near)
    assert missed_of_a_share(robot, axes, np.zeros_like(axes))[0] < 1e-6


SHORT = {**ARM, "a3": 0.0, "d4": ARM["a2"]}
AT_ZERO, IN_METRES = {**SHORT, "a1": 0.0}, {k: v / 1000.0 for k, v in SHORT.items()}
NEARLY_FREE = (
    (SHORT, 1e-3, (-180.0, 179.9999999, 90.0, -89.9999, 180.0, 90.0)),
    (IN_METRES, 1e-6, (-90.01, -179.999999999999, 90.0, -48.520286279941644, -179.999999999, 180.000000001)),
    (AT_ZERO, 1e-3, (-89.9999, -90.0, 89.9999, -179.9999, 180.0, -90.0001)),
    (AT_ZERO, 1e-3, (90.0, 90.0, 90.000001, -179.999999999, 90.0, 176.4440058711677)),
    (AT_ZERO, 8.0, (101.22729003889083, 90.0, 90.0001, 29.471001029288914, -90.0001, 0.001)),
    ({**AT_ZERO, "d6": 0.0}, 1e-3, (13.632339509401248, -90.0, 90.000001, 180.000001, 0.0, -89.999999)),
)
"""Lengths, the lateral offset, and axes at which the elbow is folded and axis 1 or 2 nearly free."""


@pytest.mark.parametrize("case", range(len(NEARLY_FREE)))
def test_a_nearly_free_axis_is_turned_until_the_pose_is_met(case: int) -> None:
    """Only some of its values leave no residual, and those that the reference has are others."""
    lengths, lateral, row = NEARLY_FREE[case]
    robot, axes = softkin.Ac6RZRYRYRXRYRZJ6Offset(**lengths, j6_offset_x=lateral), np.array([row])
    positions, rotations, configurations, _ = robot.forward_batch(axes)
    found, statuses = robot.inverse_batch(positions, rotations, configurations, np.zeros_like(axes))
    assert statuses.tolist() == [Status.OK]
    reached, turned, _, _ = robot.forward_batch(found)
    assert np.abs(reached - positions).max() < 1e-11 * sum(lengths.values())
    assert np.abs(turned - rotations).max() < 1e-11


@pytest.mark.parametrize("away", (1e6, 9e8))
def test_a_reference_many_turns_away_loses_no_pose(away: float) -> None:
    case = planted("anywhere", 60.0, 40, 19)
    assert missed(case.robot, case.axes, case.axes + away)[0] < 1e-3 * max(1.0, away * 1e-6)
