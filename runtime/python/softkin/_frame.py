"""Frames: a position and a rotation, from and to the forms in which others write them."""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, hypot, sin
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, overload

from softkin._constants import COINCIDENT, LARGEST, LARGEST_ERROR
from softkin._input import pose_of, reals, rotation_by_rows
from softkin._rotation import in_words, made_rotation
from softkin._scalar import DEGREE, RADIAN, atan2
from softkin._types import Diagnosis, FrameLike, KinematicsError, Numbers, Rotation, RotationLike, Status, Vector
from softkin._vectors import plus, product, transposed, turned

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

ORIGIN: Vector = (0.0, 0.0, 0.0)
IDENTITY: Rotation = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_NO_DIRECTION = COINCIDENT
"""Two axes are parallel where the sine of the angle between them is at most this."""


class _Parts(NamedTuple):
    position: Vector
    rotation: Rotation = IDENTITY


class Frame(_Parts):
    """A frame: position (3) in the user's length unit, and rotation by rows (3 of 3); its columns are the axes of the
    frame. It is a tuple of both, and `np.asarray(frame)` is its matrix (4, 4).

    `a @ b` is the frame b, given relative to a, in the frame of a. A method that computes with the rotation repairs it
    as the calls of a mechanism do (`orthonormalize`), and raises BAD_INPUT for a matrix that is no rotation.
    """

    __slots__ = ()
    __array_ufunc__ = None  # so that `array @ frame` is a frame, too

    @classmethod
    def of(cls, frame: FrameLike) -> Frame:
        """The frame in any form that the calls take: a `Frame`, a matrix (4, 4), or a pair of position and rotation.

        Its rotation is made orthonormal. Raises BAD_INPUT for anything else, and for numbers that are not finite.
        """
        position, rotation = pose_of(frame)
        return cls(_finite(position, "position"), orthonormalize(rotation))

    @classmethod
    def from_matrix(cls, matrix: ArrayLike) -> Frame:
        """The frame of a homogeneous matrix (4, 4), whose last row is 0 0 0 1; errors as in `of`."""
        rows = list(matrix) if isinstance(matrix, Iterable) else []
        if len(rows) != 4:
            raise KinematicsError(Status.BAD_INPUT, f"a matrix must have 4 rows of 4 numbers, not {len(rows)} rows")
        return cls.of(rows)  # type: ignore[arg-type]

    @classmethod
    def from_rotation(cls, rotation: RotationLike, position: Numbers = ORIGIN) -> Frame:
        """The frame with a rotation: three rows, or an object that has `as_matrix`, as SciPy's `Rotation`.

        It is made orthonormal; errors as in `orthonormalize`.
        """
        return cls(_place(position), orthonormalize(rotation))

    @classmethod
    def from_quaternion(cls, quaternion: Numbers, position: Numbers = ORIGIN, *, order: str = "xyzw") -> Frame:
        """The frame with the rotation of a quaternion.

        order: `xyzw`, the scalar is last, as in SciPy and ROS; or `wxyz`, the scalar is first, as in MuJoCo and Eigen's
        constructor. Raises BAD_INPUT for another order, and for a length that differs from one by more than 0.0001.
        """
        if order not in ("xyzw", "wxyz"):
            raise KinematicsError(Status.BAD_INPUT, f"the order of a quaternion is xyzw or wxyz, not {order!r}")
        given = reals(quaternion, 4, "quaternion")
        if order == "wxyz":
            given = (*given[1:], given[0])
        length = hypot(*given)
        if not abs(length - 1.0) <= LARGEST_ERROR:
            raise KinematicsError(Status.BAD_INPUT, f"quaternion not of length one by {abs(length - 1.0):.2g}: {given}")
        x, y, z, w = (number / length for number in given)
        rows = (
            (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
            (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
            (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
        )
        return cls(_place(position), rows)

    @classmethod
    def from_euler(cls, a: float, b: float, c: float, position: Numbers = ORIGIN) -> Frame:
        """The frame with the rotation of the angles A, B, C in degrees, in the convention of SoftMotion's frames.

        It is Z, Y', Z'': first A about z, then B about the new y, then C about the new z, so R = Rz(A) Ry(B) Rz(C).
        `SMC_GroupSetTool` documents it. (In G-code, A, B and C are axes of the machine.) Raises BAD_INPUT for numbers
        that are not finite.
        """
        a, b, c = _finite(reals((a, b, c), 3, "angles"), "angles")
        return cls(_place(position), product(product(_about_z(a), _about_y(b)), _about_z(c)))

    @classmethod
    def from_rpy(
        cls, roll: float, pitch: float, yaw: float, position: Numbers = ORIGIN, *, radians: bool = False
    ) -> Frame:
        """The frame with the rotation of roll, pitch and yaw, as in URDF and ROS: R = Rz(yaw) Ry(pitch) Rx(roll).

        The angles are in degrees, as everywhere here; `radians=True` takes those of a URDF as they stand there. Raises
        BAD_INPUT for numbers that are not finite.
        """
        x, y, z = _finite(reals((roll, pitch, yaw), 3, "angles"), "angles")
        if radians:
            x, y, z = RADIAN * x, RADIAN * y, RADIAN * z
        return cls(_place(position), product(product(_about_z(z), _about_y(y)), _about_x(x)))

    @property
    def matrix(self) -> NDArray[np.float64]:
        """The homogeneous matrix (4, 4), as it stands: no rotation is repaired."""
        import numpy as np

        found = np.eye(4)
        found[:3, :3] = self.rotation
        found[:3, 3] = self.position
        return found

    @property
    def quaternion(self) -> tuple[float, float, float, float]:
        """The quaternion x, y, z, w of length one.

        w is at least 0; if it is 0, the first number that is not 0 is positive.
        """
        return _quaternion(orthonormalize(self.rotation))

    @property
    def euler(self) -> Vector:
        """The angles A, B, C in degrees, as `from_euler` takes them: B in [0, 180], A and C in [-180, 180].

        Where z of the frame is parallel to z (gimbal lock: the sine of B is at most 1e-11), A and C turn about
        the same axis: then A is 0, B is 0 or 180, and C is the whole turn.
        """
        (_, _, x), (_, _, y), (_, _, z) = rotation = orthonormalize(self.rotation)
        across = hypot(x, y)
        cos_a, sin_a = (x / across, y / across) if across > _NO_DIRECTION else (1.0, 0.0)
        a = atan2(sin_a, cos_a)
        # the second row of Rz(-A) R is that of Rz(C): so A and C together are exact where each alone is not
        (r11, r12, _), (r21, r22, _), _ = rotation
        c = atan2(cos_a * r21 - sin_a * r11, cos_a * r22 - sin_a * r12)
        b = atan2(across if across > _NO_DIRECTION else 0.0, z)
        return RADIAN * a, RADIAN * b, RADIAN * c

    @property
    def rpy(self) -> Vector:
        """Roll, pitch and yaw in degrees, as `from_rpy` takes them: pitch in [-90, 90].

        Where x of the frame is parallel to z (the cosine of the pitch is at most 1e-11), yaw is 0, roll the whole turn.
        """
        (x, r12, r13), (y, r22, r23), (z, _, _) = orthonormalize(self.rotation)
        across = hypot(x, y)
        cos_yaw, sin_yaw = (x / across, y / across) if across > _NO_DIRECTION else (1.0, 0.0)
        # the second row of Rz(-yaw) R is that of Rx(roll)
        roll = atan2(sin_yaw * r13 - cos_yaw * r23, cos_yaw * r22 - sin_yaw * r12)
        pitch = atan2(0.0 - z, across if across > _NO_DIRECTION else 0.0)
        return RADIAN * roll, RADIAN * pitch, RADIAN * atan2(sin_yaw, cos_yaw)

    def shifted(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Frame:
        """This frame moved along the axes in which it is given; `frame @ Frame((x, y, z))` moves it along its own."""
        return Frame(plus(self.position, _place((x, y, z))), self.rotation)

    def inverse(self) -> Frame:
        """The frame in which this one is the origin: `frame @ frame.inverse()` is the identity."""
        back = transposed(orthonormalize(self.rotation))
        x, y, z = turned(back, self.position)
        return Frame((0.0 - x, 0.0 - y, 0.0 - z), back)

    @overload
    def __matmul__(self, other: Vector) -> Vector: ...

    @overload
    def __matmul__(self, other: NDArray[Any]) -> Any: ...

    @overload
    def __matmul__(self, other: FrameLike) -> Frame: ...

    def __matmul__(self, other: Any) -> Any:
        """The other frame, or a point, which is given relative to this one; in the coordinates of this one.

        other: a frame in any form; the three numbers of a point, which give a tuple; or an array of points (..., 3),
        which gives an array of this shape. An array (3, 3) is three points: for a rotation see `from_rotation`.
        """
        base = orthonormalize(self.rotation)
        if getattr(other, "shape", ())[-1:] == (3,):
            import numpy as np

            return np.asarray(other, np.float64) @ np.asarray(base).T + self.position
        if isinstance(other, tuple | list) and not any(isinstance(v, Iterable) for v in other):
            return plus(self.position, turned(base, _place(other)))
        position, rotation = Frame.of(other)
        return Frame(plus(self.position, turned(base, position)), product(base, rotation))

    def __rmatmul__(self, other: FrameLike) -> Frame:
        """This frame, which is given relative to the other one: a matrix (4, 4) or a pair."""
        return Frame.of(other) @ self

    def __add__(self, other: object) -> NoReturn:
        """A frame is no sum: the concatenation of tuples would be no frame."""
        raise TypeError("frames are not added: `frame.shifted(x, y, z)` moves a frame, `a @ b` puts b into a")

    __radd__ = __mul__ = __rmul__ = __add__

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        """The homogeneous matrix (4, 4)."""
        if copy is False:
            raise ValueError("a frame is no array: its matrix is a copy")
        return self.matrix if dtype is None else self.matrix.astype(dtype)


def orthonormalize(rotation: RotationLike, largest_error: float = LARGEST_ERROR) -> Rotation:
    """The rotation made orthonormal: z keeps its direction, x is made perpendicular to it, y = z x x.

    rotation: 3 rows of 3, or an object that has `as_matrix`.
    largest_error: no entry of |R^T R - I| may be larger; the default is what all calls accept. Up to it the result is
    that of the calls and of the blocks: a rotation that is exact to 1e-12 is returned as it is.
    Raises BAD_INPUT for a matrix that is no rotation; the message says by how much.
    """
    rows = rotation_by_rows(rotation)
    made = made_rotation(rows)
    if isinstance(made, Diagnosis) and largest_error > LARGEST_ERROR and _error(rows) <= largest_error:
        made = made_rotation(_orthogonal(rows))
    if isinstance(made, Diagnosis):
        raise KinematicsError(made.status, f"no rotation: {in_words(made)}", made)
    return made


def _about_x(angle: float) -> Rotation:
    c, s = cos(DEGREE * angle), sin(DEGREE * angle)
    return (1.0, 0.0, 0.0), (0.0, c, -s), (0.0, s, c)


def _about_y(angle: float) -> Rotation:
    c, s = cos(DEGREE * angle), sin(DEGREE * angle)
    return (c, 0.0, s), (0.0, 1.0, 0.0), (-s, 0.0, c)


def _about_z(angle: float) -> Rotation:
    c, s = cos(DEGREE * angle), sin(DEGREE * angle)
    return (c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)


def _error(rows: Rotation) -> float:
    """The largest entry of |R^T R - I|; NaN entries are infinite errors."""
    gram = product(transposed(rows), rows)
    entries = [abs(gram[i][k] - float(i == k)) for i in range(3) for k in range(3)]
    return max(entries) if all(entry <= LARGEST for entry in entries) else float("inf")


def _orthogonal(rows: Rotation) -> Rotation:
    """The rotation with z of the matrix, and x next to its x; a mirrored matrix stays one, and is refused."""
    x, y, z = zip(*rows, strict=True)
    e3 = _unit(z)
    along = sum(a * b for a, b in zip(x, e3, strict=True))
    e1 = _unit(tuple(a - along * b for a, b in zip(x, e3, strict=True)))
    e2 = (e3[1] * e1[2] - e3[2] * e1[1], e3[2] * e1[0] - e3[0] * e1[2], e3[0] * e1[1] - e3[1] * e1[0])
    if sum(a * b for a, b in zip(e2, y, strict=True)) < 0.0:
        e2 = (-e2[0], -e2[1], -e2[2])
    return transposed((e1, e2, e3))


def _unit(vector: tuple[float, ...]) -> Vector:
    size = hypot(*vector) or 1.0
    x, y, z = vector
    return x / size, y / size, z / size


def _quaternion(rotation: Rotation) -> tuple[float, float, float, float]:
    """The quaternion of a rotation, from the largest of its four squares."""
    (a, b, c), (d, e, f), (g, h, i) = rotation
    squares = 1.0 + a - e - i, 1.0 - a + e - i, 1.0 - a - e + i, 1.0 + a + e + i
    rows = (
        (squares[0], b + d, c + g, h - f),
        (b + d, squares[1], f + h, c - g),
        (c + g, f + h, squares[2], d - b),
        (h - f, c - g, d - b, squares[3]),
    )
    largest = rows[squares.index(max(squares))]
    length = hypot(*largest)
    x, y, z, w = (number / length + 0.0 for number in largest)
    leading = next((number for number in (w, x, y, z) if number), 1.0)
    return (x, y, z, w) if leading > 0.0 else (0.0 - x, 0.0 - y, 0.0 - z, 0.0 - w)


def _place(position: Numbers) -> Vector:
    return _finite(reals(position, 3, "position"), "position")


def _finite(numbers: tuple[float, ...], what: str) -> Vector:
    x, y, z = numbers
    if not all(abs(number) <= LARGEST for number in numbers):
        raise KinematicsError(Status.BAD_INPUT, f"{what} must be finite numbers of at most 1e9 in size, not {numbers}")
    return x, y, z
