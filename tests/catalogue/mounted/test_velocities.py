"""Velocities, Jacobians and singularities, bare and mounted: the truth is differences of forward kinematics."""

import math

import numpy as np
import pytest
import softkin
from softkin import Frame, KinematicsError, Status

from derive.description.mechanism import Mechanism
from tests.catalogue.closure import Array
from tests.catalogue.mounted.machines import BASE, EVERY, Sample, couplings, sample_of, tools_of
from tests.catalogue.refusals import refusal

pytestmark = pytest.mark.long("Hexapod")

EVERY_MECHANISM = pytest.mark.parametrize("mechanism", EVERY, ids=lambda m: m.name)
EVERY_ONE = pytest.mark.parametrize("mechanism", (*EVERY, *couplings()), ids=lambda m: getattr(m, "name", m))
"""Mechanisms, and couplings by their names."""
STEP = 1e-5
"""Radians, or parts of the reach."""


def both(sample: Sample) -> tuple[softkin.Mechanism, ...]:
    """The bare machine, on a base that turns about z alone, and on an inclined one, each with a tool."""
    tools = tools_of(sample)
    level = Frame.from_euler(30.0, 0.0, 0.0, (5.0, 6.0, 7.0))
    return (
        sample.robot,
        sample.robot.with_tool(tools[0]).with_base(level),
        sample.robot.with_tool(tools[-1]).with_base(BASE),
    )


def twists(robot: softkin.Mechanism, axes: Array, reach: float) -> Array:
    """All six rows of the twist by central differences of forward kinematics, a column for each axis, per radian."""
    columns = []
    for k, axis in enumerate(robot.AXES):
        step = STEP if axis.unit == "deg" else STEP * reach
        shift = np.zeros(len(axes))
        shift[k] = math.degrees(step) if axis.unit == "deg" else step
        (ahead, _), (behind, _) = (robot.forward(axes + sign * shift) for sign in (1.0, -1.0))
        turn = (np.array(ahead.rotation) - behind.rotation) @ np.array(robot.forward(axes)[0].rotation).T / (2.0 * step)
        about = [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        moved = (np.array(ahead.position) - behind.position) / (2.0 * step)
        columns.append([*moved, *(0.5 * a for a in about)])
    return np.array(columns).T.reshape(6, len(robot.AXES))


def rows_of(robot: softkin.Mechanism, axes: Array, reach: float) -> Array:
    """The rows of the Jacobian, of these differences."""
    six = twists(robot, axes, reach)
    frame = np.array(robot.forward(axes)[0].rotation)
    tilts = frame.T @ six[3:]
    names = ("x", "y", "z", "turn x", "turn y", "turn z", "tilt x", "tilt y")
    known = dict(zip(names, (*six, *tilts), strict=False))
    tool = robot.tool.rotation if isinstance(robot, softkin.Mounted) else np.eye(3)
    known["pitch"] = (frame @ np.transpose(tool))[:, 1] @ six[3:]  # about y of the flange, as the joints that pitch it
    return np.array([known[name] for name in robot.JACOBIAN_ROWS]).reshape(len(robot.JACOBIAN_ROWS), len(robot.AXES))


def matrix_of(robot: softkin.Mechanism, axes: Array) -> Array:
    """The Jacobian, with its shape where it has no rows or columns."""
    return np.reshape(robot.jacobian(axes), (len(robot.JACOBIAN_ROWS), len(robot.AXES)))


@EVERY_ONE
def test_the_jacobian_is_the_difference_of_forward(mechanism: Mechanism | str) -> None:
    """Every row, bare and mounted; a batch is the same; statuses and margins of garbage."""
    sample = sample_of(mechanism)
    for robot in both(sample):
        for axes in sample.axes[:3]:
            scale = sample.reach + 600.0
            missed = matrix_of(robot, axes) - rows_of(robot, axes, sample.reach)
            assert np.abs(missed).max(initial=0.0) < 1e-7 * scale
        rows = np.vstack([sample.axes, np.full((1, sample.axes.shape[1]), np.nan)])
        matrices, statuses = robot.jacobian_batch(rows)
        assert matrices.shape == (len(rows), len(robot.JACOBIAN_ROWS), len(robot.AXES))
        singular, margins = robot.singularity_batch(rows)
        assert singular.dtype == np.bool_ and margins.shape == (len(rows), len(robot.MARGINS))
        for row, matrix, flag, margin in zip(sample.axes, matrices, singular, margins, strict=False):
            alone = matrix_of(robot, row)
            assert np.abs(matrix - alone).max(initial=0.0) < 1e-12 * (sample.reach + 600.0)
            found = robot.singularity(row)
            assert flag == found.is_singular
            assert list(margin) == pytest.approx(list(found.margins.values()), abs=1e-12)
        if robot.AXES:
            assert statuses.tolist() == [Status.OK] * len(sample.axes) + [Status.BAD_INPUT]
            assert np.isnan(matrices[-1]).all() and singular[-1] and np.isnan(margins[-1]).all()


@EVERY_ONE
def test_velocities_of_axes_and_frame_are_inverse(mechanism: Mechanism | str) -> None:
    """`axis_velocities` is the inverse of `twist`, with the velocities of held axes given; damping changes little."""
    sample = sample_of(mechanism)
    rng = np.random.default_rng(2)
    for robot in both(sample):
        for axes in sample.axes[:3]:
            velocities = rng.uniform(-1.0, 1.0, len(axes))
            twist = robot.twist(axes, velocities)
            assert np.array(twist) == pytest.approx(matrix_of(robot, axes) @ velocities, abs=1e-9 * sample.reach)
            held = velocities[list(robot.HELD)]
            if robot.singularity(axes).is_singular:
                continue
            assert robot.axis_velocities(axes, twist, held=held) == pytest.approx(tuple(velocities), abs=1e-6)
            damped = robot.axis_velocities(axes, twist, held=held, damping=1e-7, length=sample.reach)
            assert damped == pytest.approx(tuple(velocities), abs=1e-3 * sample.reach)


@EVERY_MECHANISM
def test_measures_are_those_of_the_singular_values(mechanism: Mechanism) -> None:
    """Condition and manipulability against the eigenvalues of J^T J, held axes left out; in metres the same."""
    sample = sample_of(mechanism)
    robot, length = sample.robot, 0.7 * sample.reach
    free = [i for i in range(len(robot.AXES)) if i not in robot.HELD]
    if not free:
        assert robot.condition(()) == robot.manipulability(()) == 1.0
        return
    for axes in sample.axes[:3]:
        matrix = matrix_of(robot, axes)[:, free].copy()
        matrix[[i for i, row in enumerate(robot.JACOBIAN_ROWS) if row in "xyz"]] /= length
        matrix[:, [k for k, i in enumerate(free) if robot.AXES[i].unit == "u"]] *= length
        squares = np.linalg.eigvalsh(matrix.T @ matrix)
        assert robot.manipulability(axes, length) == pytest.approx(math.sqrt(abs(np.prod(squares))), rel=1e-6)
        assert robot.condition(axes, length) == pytest.approx(math.sqrt(squares[-1] / squares[0]), rel=1e-4)
        mixed = len({robot.AXES[i].unit for i in free}) > 1 or any(row[0] == "t" for row in robot.JACOBIAN_ROWS)
        if mixed and len({row in "xyz" for row in robot.JACOBIAN_ROWS} | {robot.AXES[i].unit for i in free}) > 2:
            assert refusal(robot.condition, axes, says="characteristic length") is Status.BAD_INPUT


ARM = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
STRETCHED = (10.0, 20.0, 30.0, 40.0, 0.0, 60.0)
"""The wrist is straight."""


def test_a_singular_pose_is_refused_or_damped() -> None:
    """Without damping IMPOSSIBLE, with the margins; with damping finite, and small where the pose is far from it."""
    twist = (10.0, 20.0, 30.0, 0.1, 0.2, 0.3)
    assert refusal(ARM.axis_velocities, STRETCHED, twist, says=r"singular \(margins: .*wrist") is Status.IMPOSSIBLE
    found = ARM.axis_velocities(STRETCHED, twist, damping=0.01, length=400.0)
    assert np.isfinite(found).all() and max(map(abs, found)) < 1.0 / 0.02
    matrix, rows = np.array(ARM.jacobian(STRETCHED)), np.array([400.0] * 3 + [1.0] * 3)
    scaled, right = matrix / rows[:, None], np.array(twist) / rows
    normal = np.linalg.solve(scaled.T @ scaled + 1e-4 * np.eye(6), scaled.T @ right)
    assert found == pytest.approx(tuple(normal), abs=1e-9)
    assert ARM.condition(STRETCHED, 400.0) > 1e12 and ARM.manipulability(STRETCHED, 400.0) < 1e-12
    with pytest.raises(KinematicsError, match="characteristic length"):
        ARM.axis_velocities(STRETCHED, twist, damping=0.01)


def test_a_motion_that_the_axes_do_not_have_is_refused() -> None:
    """A coupling with four axes has six rows: a tilt is refused, with its name; damped it is as near as possible."""
    robot = couplings()["scara, C"]
    axes = (10.0, 50.0, 30.0, 40.0)
    assert robot.axis_velocities(axes, (1.0, 2.0, 3.0, 0.0, 0.0, 0.5)) == pytest.approx(
        robot.axis_velocities(axes, (1.0, 2.0, 3.0, 0.0, 0.0, 0.5), damping=1e-9, length=300.0), abs=1e-6
    )
    tilted = (1.0, 2.0, 3.0, 0.0, 5.0, 0.5)
    assert refusal(robot.axis_velocities, axes, tilted, says="turn y is missed") is Status.UNREACHABLE


def test_the_velocity_of_a_held_axis_is_the_caller_s() -> None:
    """The rail moves as given, the arm makes up for it; the tool stands still."""
    sample = sample_of(next(m for m in EVERY if m.name == "Softkin_ScaraOnRail"))
    robot, axes = sample.robot, sample.axes[0]
    still = (0.0,) * len(robot.JACOBIAN_ROWS)
    found = robot.axis_velocities(axes, still, held=(25.0,))
    assert found[0] == 25.0 and max(map(abs, found[1:])) > 0.01
    assert robot.twist(axes, found) == pytest.approx(still, abs=1e-9)
    assert robot.axis_velocities(axes, still) == pytest.approx((0.0,) * 5)
    with pytest.raises(KinematicsError, match="held must be 1 numbers"):
        robot.axis_velocities(axes, still, held=(1.0, 2.0))


@pytest.mark.parametrize(
    ("call", "arguments", "message"),
    [
        ("twist", ((1.0,) * 5,), "velocities must be 6 numbers, not 5"),
        ("twist", ((math.nan,) * 6,), "velocities must be finite"),
        ("axis_velocities", ((1.0,) * 5,), "twist must be 6 numbers, not 5"),
        ("axis_velocities", ((math.inf,) * 6,), "twist must be finite"),
        ("condition", (0.0,), "length must be positive"),
        ("condition", (-1.0,), "length must be positive"),
        ("manipulability", (math.nan,), "length must be finite"),
        ("manipulability", (), "characteristic length"),
    ],
)
def test_wrong_arguments_are_refused(call: str, arguments: tuple[object, ...], message: str) -> None:
    axes = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0)
    assert refusal(getattr(ARM, call), axes, *arguments, says=message) is Status.BAD_INPUT
    for damping in (-1.0, math.nan, math.inf):
        with pytest.raises(KinematicsError, match="damping must be"):
            ARM.axis_velocities(axes, (0.0,) * 6, damping=damping, length=1.0)
