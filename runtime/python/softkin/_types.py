"""The types of the arguments and results of a mechanism."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple, Protocol, Self, TypeAlias

from softkin._constants import LARGEST, LEAST, STATUSES, USUAL

Vector: TypeAlias = tuple[float, float, float]
Rotation: TypeAlias = tuple[Vector, Vector, Vector]
"""Three rows; the columns are the axes of the frame."""
Reals: TypeAlias = tuple[float, ...]
Values: TypeAlias = tuple[Any, ...]
"""Numbers and truth values together."""
Signs: TypeAlias = tuple[int, ...]
"""The signs of the branches: 1 for byte 1, -1 for byte 2."""
Turns: TypeAlias = tuple[int, ...]
"""The signed numbers of the turns of axes; 0 where none is commanded."""
Matrix: TypeAlias = tuple[Reals, ...]
Configuration: TypeAlias = tuple[int, ...]
"""The branch bytes, then a signed period number for every axis that turns more than once."""

ConfigurationLike: TypeAlias = Iterable[int] | Mapping[str, Any] | str
"""A configuration as `forward` gives it or `Mechanism.configuration` makes it, or names: `{"elbow": "left", "A4": 2}`,
or those of branches alone, as "left" or "left flip". What is not named is as in the default."""

Numbers: TypeAlias = Iterable[float]


class SupportsArray(Protocol):
    """An object that becomes a NumPy array: a matrix (4, 4) where it is a frame."""

    def __array__(self) -> Any: ...


class SupportsMatrix(Protocol):
    """A rotation that has a matrix (3, 3), as SciPy's `Rotation`."""

    def as_matrix(self) -> Any: ...


RotationLike: TypeAlias = Iterable[Numbers] | SupportsMatrix
"""Three rows, or a rotation that has `as_matrix`."""
FrameLike: TypeAlias = tuple[Numbers, RotationLike] | Sequence[Numbers] | SupportsArray
"""A `Frame`, a pair of a position and a rotation, of any sequence type, or a matrix (4, 4)."""
PlainFrame: TypeAlias = tuple[Vector, Rotation]
"""A frame in tuples of floats: a `Frame`, or the pair alone, which is read a little faster."""


class Status(IntEnum):
    """The outcome of a call. Batch calls return one `uint8` for each row: `statuses == Status.OK` is a mask."""

    softmotion: str
    """The name in SoftMotion's enumeration of errors."""
    meaning: str

    def __new__(cls, code: int, softmotion: str, meaning: str) -> Self:
        """A status by its code."""
        member = int.__new__(cls, code)
        member._value_ = code
        member.softmotion = softmotion
        member.meaning = meaning
        return member

    OK = STATUSES["OK"]
    NOT_INITIALIZED = STATUSES["NOT_INITIALIZED"]
    BAD_INPUT = STATUSES["BAD_INPUT"]
    UNREACHABLE = STATUSES["UNREACHABLE"]
    IMPOSSIBLE = STATUSES["IMPOSSIBLE"]
    INVALID_COUPLING = STATUSES["INVALID_COUPLING"]


class KinematicsError(ValueError):
    """The error of a call that fails: `status` says why, and the message says what is wrong.

    `refusal` has the reason of an inverse that refuses, with the missing amount; it is None for any other call.
    """

    def __init__(self, status: Status, message: str, refusal: Diagnosis | None = None) -> None:
        """An error with its status."""
        super().__init__(message)
        self.status = status
        self.refusal = refusal

    def __reduce__(self) -> tuple[type[KinematicsError], tuple[Status, str, Diagnosis | None]]:
        """Copying and pickling keep the refusal."""
        return type(self), (self.status, str(self), self.refusal)


class Solution(NamedTuple):
    """One slot of the inverse: the axes, or the status that says why there are none."""

    configuration: Configuration
    """The branch bytes of the slot, and the period numbers of its axes (0 if there are none)."""
    axes: Reals | None
    status: Status
    others: tuple[Reals, ...] = ()
    """Further solutions on the same branch, where the inverse is a root search, the nearest to the reference first."""
    refusal: Diagnosis | None = None
    """Why there are no axes, as `diagnose` says: which axis is beyond a limit, and by how much."""


class Diagnosis(NamedTuple):
    """The reason why the inverse refuses; if it does not refuse, status OK with an empty reason."""

    status: Status
    reason: str
    """The reason, with the name of the quantity that refuses."""
    missing: float
    """The missing amount of this quantity, in its own unit; 0 if there is no amount."""
    turn: int = 0
    """If the turn of an axis is the reason: the number of a turn inside the limits; 0 if there is none."""
    projection: float = 0.0
    """With status OK, the angle between the commanded rotation and that of the answer, in degrees (`in_radians()`: in
    radians): 0 for a machine that takes the whole rotation, or reads none."""

    @property
    def in_words(self) -> str:
        """The reason, followed by the amount in its unit and the turn, if there are any."""
        text, unit = split_unit(self.reason)
        amount = f", missing {float(f'{self.missing:.4g}')!r}" + (f" {unit}" if unit else "") if self.missing else ""
        return text + amount + (f", which is turn {self.turn}" if self.turn else "")


def split_unit(reason: str) -> tuple[str, str]:
    """A reason without the unit at its end, and the unit: `A2: out of reach [u]`."""
    text, bracket, unit = reason.rpartition(" [")
    return (text, unit[:-1]) if bracket and unit.endswith("]") and unit[:-1] in ("u", "deg", "rad") else (reason, "")


class Singularity(NamedTuple):
    """The distances of a pose from all singularities."""

    is_singular: bool
    """Whether a margin is smaller in size than the parameter `warning_distance`, or the axes allow no pose."""
    margins: Mapping[str, float]
    """Dimensionless and signed, by name; NaN if the axes allow no pose.

    In a machine without lengths (a polar arm, a crane) a margin that is a distance is 0 where an axis is not
    determined, else 1.
    """


class OrientationImage(NamedTuple):
    """The orientations that the flange can have: rotations about an axis, applied to one of its orientations."""

    freedom: str
    """`zero`, `one` or `three` degrees of freedom."""
    rotation: Rotation
    base_axis: Vector
    flange_axis: Vector
    """`rotation` times this is `base_axis`."""


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis of the controller."""

    name: str
    kind: str
    """`rotary`, `linear`, or `helical`: a helical axis turns, and moves another axis along by its pitch."""
    unit: str
    """`deg`, or `u`: the user's length unit."""
    meaning: str
    multi_turn: bool
    """Whether the configuration has a period number for the axis."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a mechanism: a keyword of its class."""

    name: str
    kind: str
    unit: str
    meaning: str
    low: float
    high: float
    low_is_open: bool
    """Whether the value must be more than `low`, and more than LEAST, so that no product of lengths vanishes."""
    default: float | None
    """None if the parameter must be given."""

    @classmethod
    def of(cls, kind: str, name: str, meaning: str, **unusual: Any) -> Self:
        """A parameter of a kind. unusual: its unit, its range or its default, if they differ from those of the kind."""
        return cls(name=name, kind=kind, meaning=meaning, **{**USUAL[kind], **unusual})

    def allows(self, value: float) -> bool:
        """Whether a number, or the truth value of a flag, is in the range."""
        if self.kind == "flag":
            return True
        if self.kind == "sign":
            return value in (1, -1)
        if self.kind in ("signed length", "transmission") and not (value > LEAST or value < -LEAST):
            return False
        above = value > max(self.low, LEAST) if self.low_is_open else value >= self.low
        return above and value <= min(self.high, LARGEST)

    @property
    def range(self) -> str:
        """The values that are allowed, in words."""
        if self.kind == "flag":
            return "True or False"
        if self.kind == "sign":
            return "1 or -1"
        low = f"more than {max(self.low, LEAST):g}" if self.low_is_open else f"at least {self.low:g}"
        size = f", and more than {LEAST:g} in size" if self.kind in ("signed length", "transmission") else ""
        return f"{low} and at most {self.high:g}{size}"


@dataclass(frozen=True, slots=True)
class ConfigurationByte:
    """A byte of the configuration.

    The byte of a branch is 1 or 2; 0 is automatic, and 3 says that both coincide. The byte of a period is the signed
    number of the turn; 0 is automatic, see `Mechanism.inverse`.
    """

    name: str
    kind: str
    """`branch` or `period`."""
    branches: tuple[str, ...]
    """The names of branch 1 and branch 2; empty for a period."""
    default: int
