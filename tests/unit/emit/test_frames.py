"""Frames of the package: every form in which they are written, against products of matrices written down here."""

import math
import pickle

import numpy as np
import pytest
import softkin
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from softkin import Frame, KinematicsError, Status, orthonormalize

from tests.orthonormal import about

Array = NDArray[np.float64]
ANGLES = st.floats(-720.0, 720.0)
NUMBERS = st.floats(-1e3, 1e3)
PLACES = st.tuples(NUMBERS, NUMBERS, NUMBERS)
IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def exponential(quaternion: tuple[float, ...]) -> Array:
    """The rotation of a quaternion x, y, z, w by Rodrigues' formula."""
    x, y, z, w = np.array(quaternion) / np.linalg.norm(quaternion)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross)


@given(ANGLES, ANGLES, ANGLES, PLACES)
def test_angles_are_z_y_z(a: float, b: float, c: float, place: tuple[float, float, float]) -> None:
    """R = Rz(A) Ry(B) Rz(C), and back to the same rotation, in the ranges that are documented."""
    frame = Frame.from_euler(a, b, c, place)
    assert np.abs(frame.rotation - about(2, a) @ about(1, b) @ about(2, c)).max() < 1e-14
    assert frame.position == place
    found = frame.euler
    assert 0.0 <= found[1] <= 180.0 and all(-180.0 <= angle <= 180.0 for angle in (found[0], found[2]))
    again = Frame.from_euler(*found, place)
    assert np.abs(np.subtract(again.rotation, frame.rotation)).max() < 2e-11


@pytest.mark.parametrize("b", [0.0, 180.0, -180.0, 1e-13, 180.0 - 1e-13])
def test_where_z_is_parallel_one_angle_has_the_turn(b: float) -> None:
    """Gimbal lock: A is 0, B is 0 or 180, C the whole turn."""
    for a, c in ((30.0, 40.0), (-170.0, -100.0), (0.0, 0.0), (180.0, 0.0)):
        frame = Frame.from_euler(a, b, c)
        found = frame.euler
        assert found[0] == 0.0 and found[1] in (0.0, 180.0)
        assert np.abs(np.subtract(Frame.from_euler(*found).rotation, frame.rotation)).max() < 1e-11


@pytest.mark.parametrize("b", [1e-9, 1e-6, 1e-3, 180.0 - 1e-9, 180.0 - 1e-4])
def test_near_gimbal_lock_no_digits_are_lost(b: float) -> None:
    """Each of A and C has few digits there, and both together have all."""
    for a, c in ((30.0, 40.0), (-170.0, -100.0), (95.0, -20.0)):
        frame = Frame.from_euler(a, b, c)
        assert np.abs(np.subtract(Frame.from_euler(*frame.euler).rotation, frame.rotation)).max() < 1e-14


@given(st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda q: math.hypot(*q) > 0.1), PLACES)
def test_quaternions_have_the_scalar_last(quaternion: tuple[float, ...], place: tuple[float, float, float]) -> None:
    """x, y, z, w by Rodrigues' formula, and back with w at least 0."""
    unit = tuple(np.array(quaternion) / np.linalg.norm(quaternion))
    frame = Frame.from_quaternion(unit, place)
    assert np.abs(frame.rotation - exponential(quaternion)).max() < 1e-14
    found = frame.quaternion
    assert found[3] >= 0.0 and math.hypot(*found) == pytest.approx(1.0, abs=1e-15)
    assert abs(abs(np.dot(found, unit)) - 1.0) < 1e-14
    assert np.abs(np.subtract(Frame.from_quaternion(found).rotation, frame.rotation)).max() < 1e-14


def test_half_turns_have_one_quaternion() -> None:
    """Where w is 0, the first other number is positive; a quaternion from single precision is accepted."""
    for axis, expected in ((0, (1.0, 0.0, 0.0, 0.0)), (1, (0.0, 1.0, 0.0, 0.0)), (2, (0.0, 0.0, 1.0, 0.0))):
        rotation = np.diag([1.0 if k == axis else -1.0 for k in range(3)])
        assert Frame((0.0, 0.0, 0.0), rotation).quaternion == expected
    rounded = np.float32([0.1, 0.2, 0.3, math.sqrt(0.86)])
    assert np.abs(np.array(Frame.from_quaternion(rounded).quaternion) - rounded).max() < 1e-7
    with pytest.raises(KinematicsError, match="length one by 0.01") as refusal:
        Frame.from_quaternion((1.01, 0.0, 0.0, 0.0))
    assert refusal.value.status is Status.BAD_INPUT
    for wrong in ((0.0,) * 4, (math.nan,) * 4, (1.0, 0.0, 0.0), (math.inf, 0.0, 0.0, 0.0)):
        with pytest.raises(KinematicsError):
            Frame.from_quaternion(wrong)


@given(ANGLES, ANGLES, ANGLES, PLACES)
def test_roll_pitch_yaw(roll: float, pitch: float, yaw: float, place: tuple[float, float, float]) -> None:
    """R = Rz(yaw) Ry(pitch) Rx(roll), in degrees and in radians, and back to the same rotation."""
    frame = Frame.from_rpy(roll, pitch, yaw, place)
    assert np.abs(frame.rotation - about(2, yaw) @ about(1, pitch) @ about(0, roll)).max() < 1e-14
    assert frame.position == place
    in_radians = Frame.from_rpy(*map(math.radians, (roll, pitch, yaw)), radians=True)
    assert np.abs(np.subtract(in_radians.rotation, frame.rotation)).max() < 1e-14
    assert -90.0 <= frame.rpy[1] <= 90.0
    assert np.abs(np.subtract(Frame.from_rpy(*frame.rpy).rotation, frame.rotation)).max() < 2e-11


@pytest.mark.parametrize("pitch", [90.0, -90.0, 90.0 - 1e-13, 90.0 - 1e-9, -90.0 + 1e-4])
def test_roll_and_yaw_about_one_axis(pitch: float) -> None:
    """Where x is parallel to z, yaw is 0 and roll has the whole turn; near there no digits are lost."""
    for roll, yaw in ((30.0, 40.0), (-170.0, -100.0), (0.0, 0.0)):
        frame = Frame.from_rpy(roll, pitch, yaw)
        assert np.abs(np.subtract(Frame.from_rpy(*frame.rpy).rotation, frame.rotation)).max() < 1e-11
        assert frame.rpy[2] == 0.0 or abs(abs(pitch) - 90.0) > 1e-10


@given(ANGLES, ANGLES, ANGLES, PLACES, PLACES)
def test_points(
    a: float, b: float, c: float, place: tuple[float, float, float], at: tuple[float, float, float]
) -> None:
    """A point is the last column of a frame: as a tuple, as a list, as an array, as a row of an array."""
    frame = Frame.from_euler(a, b, c, place)
    expected = (frame.matrix @ [*at, 1.0])[:3]
    rows = frame @ np.array([[at, place], [place, at]])
    assert isinstance(frame @ at, tuple) and isinstance(frame @ np.array(at), np.ndarray)
    for found in (frame @ at, frame @ list(at), frame @ np.array(at), rows[0, 0], rows[1, 1]):
        assert np.abs(np.subtract(found, expected)).max() < 1e-11
    assert rows.shape == (2, 2, 3)
    assert frame.shifted(*at) == (tuple(p + d for p, d in zip(place, at, strict=True)), frame.rotation)
    assert frame.shifted(z=1.0).position == (place[0], place[1], place[2] + 1.0)


def test_rotations_of_scipy() -> None:
    """SciPy's `Rotation` stands for a matrix wherever one is taken, and quaternions have the order that is named."""
    turn = Rotation.from_euler("xyz", [10.0, 20.0, 30.0], degrees=True)
    frame = Frame.from_rotation(turn, (1.0, 2.0, 3.0))
    assert frame == Frame.of(((1.0, 2.0, 3.0), turn)) == Frame.from_rotation(turn.as_matrix(), (1.0, 2.0, 3.0))
    assert np.abs(np.subtract(frame.rotation, Frame.from_rpy(10.0, 20.0, 30.0).rotation)).max() < 1e-15
    assert orthonormalize(turn) == frame.rotation and (frame.inverse() @ (frame.position, turn)).position == (0, 0, 0)
    x, y, z, w = turn.as_quat()
    for other in (Frame.from_quaternion((x, y, z, w)), Frame.from_quaternion((w, x, y, z), order="wxyz")):
        assert np.abs(np.subtract(other.rotation, frame.rotation)).max() < 1e-15
    with pytest.raises(KinematicsError, match="xyzw or wxyz, not 'zyxw'"):
        Frame.from_quaternion((x, y, z, w), order="zyxw")
    arm = softkin.ArticulatedRobot6DOF(a2=300.0, d4=250.0, d6=80.0)
    place = (300.0, 20.0, 100.0)
    assert arm.inverse((place, turn)) == arm.inverse((place, turn.as_matrix()))
    found = arm.inverse_batch([place] * 2, Rotation.concatenate([turn, turn]))[0]
    assert np.abs(found - arm.inverse((place, turn))).max() < 1e-9


def test_frames_are_not_added() -> None:
    """A sum or a multiple of tuples is no frame: the message names what is."""
    frame = Frame((1.0, 2.0, 3.0))
    for wrong in (lambda: frame + (0, 0, 5), lambda: (0, 0, 5) + frame, lambda: frame * 2, lambda: 2 * frame):
        with pytest.raises(TypeError, match=r"frame.shifted\(x, y, z\)"):
            wrong()
    for point in ((1.0, math.nan, 2.0), (1.0, "2", 3.0), (1.0, 2.0)):
        with pytest.raises(KinematicsError, match="finite|a frame must be|must be 3 numbers, not 2"):
            frame @ point  # type: ignore[operator]


@given(*[st.tuples(ANGLES, ANGLES, ANGLES, PLACES)] * 2)
def test_frames_multiply_as_matrices(first: tuple[object, ...], second: tuple[object, ...]) -> None:
    a, b = Frame.from_euler(*first), Frame.from_euler(*second)  # type: ignore[arg-type]
    expected = a.matrix @ b.matrix
    for product in (a @ b, a @ b.matrix, a @ (b.position, b.rotation), a.matrix @ b, tuple(a) @ b):
        assert isinstance(product, Frame) and np.abs(product.matrix - expected).max() < 1e-11
    assert np.abs((a @ a.inverse()).matrix - np.eye(4)).max() < 1e-11
    assert np.abs(a.inverse().matrix - np.linalg.inv(a.matrix)).max() < 1e-11


def test_a_frame_is_a_pair_and_an_array() -> None:
    """It unpacks as position and rotation; NumPy sees the matrix (4, 4), alone and in lists; it is immutable."""
    frame = Frame.from_euler(10.0, 20.0, 30.0, (1.0, 2.0, 3.0))
    position, rotation = frame
    assert frame == (position, rotation) and hash(frame) == hash((position, rotation))
    matrix = np.asarray(frame)
    assert matrix.shape == (4, 4) and matrix.dtype == np.float64
    assert (matrix[:3, :3] == rotation).all() and (matrix[:3, 3] == position).all()
    assert matrix[3].tolist() == [0.0, 0.0, 0.0, 1.0]
    assert np.array([frame, frame]).shape == (2, 4, 4) and np.asarray(frame, np.float32).dtype == np.float32
    assert Frame.from_matrix(matrix) == Frame.of(matrix) == Frame.of(frame) == Frame.of((position, matrix[:3, :3]))
    assert Frame.from_matrix(matrix.tolist()) == frame == pickle.loads(pickle.dumps(frame))
    assert Frame((1.0, 2.0, 3.0)).rotation == IDENTITY and Frame((1.0, 2.0, 3.0)).matrix[0, 3] == 1.0
    assert eval(repr(frame)) == frame
    with pytest.raises(AttributeError):
        frame.position = (0.0, 0.0, 0.0)  # type: ignore[misc]
    with pytest.raises(ValueError, match="copy"):
        np.array(frame, copy=False)


def test_every_call_takes_every_form() -> None:
    robot = softkin.ArticulatedRobot6DOF(d1=400.0, a1=25.0, a2=455.0, a3=35.0, d4=420.0, d6=80.0)
    axes = (10.0, 20.0, 30.0, 40.0, 50.0, 60.0)
    frame, configuration = robot.forward(axes)
    matrix = frame.matrix
    forms = (frame, matrix, matrix.tolist(), tuple(map(tuple, matrix.tolist())), (matrix[:3, 3], matrix[:3, :3]))
    expected = robot.inverse(frame, configuration, axes)
    for form in forms:
        assert robot.inverse(form, configuration, axes) == expected
        assert robot.inverse_all(form, axes) == robot.inverse_all(frame, axes)
        assert robot.diagnose(form, configuration, axes).status is Status.OK
    for batch in ([frame] * 3, np.array([matrix] * 3), [matrix.tolist()] * 3):
        found, statuses = robot.inverse_batch(batch, None, configuration, axes)
        assert (statuses == Status.OK).all() and np.abs(found - expected).max() < 1e-9
        assert robot.inverse_all_batch(batch, None, axes)[0].shape == (3, 8, 6)
    wrong = matrix.copy()
    wrong[3] = 0.0, 0.0, 1e-3, 1.0
    for call in (robot.inverse, robot.inverse_all, robot.diagnose, Frame.of, Frame.from_matrix):
        for form, message in ((wrong, "last row"), (matrix[:3], "a frame|4 rows"), (np.eye(5), "a frame|4 rows")):
            with pytest.raises(KinematicsError, match=message) as refusal:
                call(form)
            assert refusal.value.status is Status.BAD_INPUT
    with pytest.raises(KinematicsError, match="last row"):
        robot.inverse_batch([wrong])
    assert softkin.Gantry2().inverse(Frame((1.0, 2.0, 0.0)).matrix) == (1.0, 2.0)


@given(ANGLES, ANGLES, ANGLES, st.lists(st.floats(-1.0, 1.0), min_size=9, max_size=9))
def test_a_rounded_rotation_is_made_orthonormal(a: float, b: float, c: float, noise: list[float]) -> None:
    """To 1e-4 as the calls do it; further where it is allowed; z keeps its direction, x stays in its plane."""
    exact = np.array(Frame.from_euler(a, b, c).rotation)
    for size, most in ((1e-5, None), (3e-3, 0.05)):
        rough = exact + size * np.reshape(noise, (3, 3))
        made = np.array(orthonormalize(rough) if most is None else orthonormalize(rough, most))
        assert np.abs(made.T @ made - np.eye(3)).max() < 1e-11 and np.linalg.det(made) > 0.0
        assert np.abs(made[:, 2] - rough[:, 2] / np.linalg.norm(rough[:, 2])).max() < 1e-11
        assert abs(np.dot(np.cross(rough[:, 0], rough[:, 2]), made[:, 0])) < 1e-11
        assert np.abs(made - exact).max() < 4.0 * size + 1e-15
    assert orthonormalize(exact) == tuple(map(tuple, exact.tolist()))


def test_what_is_no_rotation_is_refused_by_how_much() -> None:
    """Too long, skewed, mirrored, not a number; more is accepted where the caller says so."""
    skewed = ((1.0, 0.01, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    for call in (orthonormalize, lambda m: Frame.of(((0.0, 0.0, 0.0), m)), lambda m: Frame((0.0, 0.0, 0.0), m).euler):
        for matrix, amount in ((skewed, "0.01"), (np.eye(3) * 1.05, "0.1"), (np.diag([1.0, 1.0, -1.0]), "")):
            with pytest.raises(KinematicsError, match=f"no rotation: .*{amount}") as refusal:
                call(matrix)
            assert refusal.value.status is Status.BAD_INPUT
    assert np.abs(np.subtract(orthonormalize(skewed, 0.02), IDENTITY)).max() < 0.02
    for wrong in (np.diag([1.0, 1.0, -1.0]), np.full((3, 3), math.nan), np.zeros((3, 3)), np.diag([1.0, -1.0, 1.0])):
        for most in (1e-4, 1.0, math.inf):
            with pytest.raises(KinematicsError):
                orthonormalize(wrong, most)
    with pytest.raises(KinematicsError, match="three rows"):
        orthonormalize([[1.0, 0.0], [0.0, 1.0]])  # type: ignore[list-item]


@pytest.mark.parametrize("garbage", [math.nan, math.inf, 2e9])
def test_numbers_that_are_none_are_refused(garbage: float) -> None:
    """In positions, angles and matrices."""
    calls = (
        lambda: Frame.from_euler(garbage, 0.0, 0.0),
        lambda: Frame.from_euler(0.0, 0.0, 0.0, (0.0, garbage, 0.0)),
        lambda: Frame.from_quaternion((0.0, 0.0, 0.0, 1.0), (garbage, 0.0, 0.0)),
        lambda: Frame.of(((0.0, 0.0, garbage), IDENTITY)),
        lambda: softkin.Gantry3().with_tool(((0.0, 0.0, garbage), IDENTITY)),
        lambda: softkin.Gantry3().with_base(((0.0, 0.0, garbage), IDENTITY)),
    )
    for call in calls:
        with pytest.raises(KinematicsError) as refusal:
            call()
        assert refusal.value.status is Status.BAD_INPUT
