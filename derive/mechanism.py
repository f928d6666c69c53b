"""The vocabulary of a mechanism description: joints, parameters, closure, task, branches.

A description states equations and their meaning, and nothing that was solved by hand. Quantities take
part in SymPy expressions directly: `Rz(A1) * Tx(link)`, `branch("elbow", sin(A2), right=+1, left=-1)`.
Inside expressions angles are in radians; `TURN` is one revolution, for couplings given per revolution.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import TypedDict, Unpack

import sympy as sp

from derive.frames import Chain
from derive.program import DEGREE, real
from derive.quantity import Quantity

TURN = 2 * sp.pi
COORDINATE_NAMES = ("x", "y", "z")
X, Y, Z = (Quantity(real(name)) for name in COORDINATE_NAMES)
"""The commanded position, for closures that are not a chain."""
ROTATION = sp.ImmutableMatrix(3, 3, [real(f"r{i}{j}") for i in "123" for j in "123"])
"""The commanded rotation, for closures that follow the whole of it."""

Interval = tuple[float, float]


class DescriptionError(Exception):
    """A mechanism description that cannot be right; the message says what and where."""


class Vendor(Enum):
    """Who sells the geometry: decides how the function block is called."""

    SINSEGYE = "Sinsegye SF512x"
    REXROTH = "Bosch Rexroth ctrlX"
    CODESYS = "CODESYS SM3_Transformation"
    TEXTBOOK = "textbook"


class Kind(Enum):
    """How a joint moves, and how its values are read."""

    LINEAR = "linear"
    ROTARY = "rotary"
    HELICAL = "helical"
    """Turns, and is declared Linear because it carries another axis along (values in degrees)."""


@dataclass(frozen=True)
class Joint(Quantity):
    """One axis: axis value = motor value + offset, joint value = motor value + coupling."""

    name: str
    kind: Kind
    meaning: str
    multi_turn: bool = False
    """Has a period byte in the configuration."""
    offset_range: Interval | None = None
    limit_range: Interval | None = None
    """The vendor's ranges, where the vendor gives them."""
    coupling: sp.Expr = sp.Integer(0)
    """What motors of earlier axes add to this joint: linear in their `motor` symbols."""
    pitch: sp.Expr = sp.Integer(0)
    """Where this is not zero, the joint is always limited (to `limit_range` where no limit is given)."""
    domain: Interval | None = None
    """What the closure itself allows (degrees or length), reported as the axis' range; None: anything."""
    nominal: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "coupling", sp.sympify(self.coupling))
        object.__setattr__(self, "pitch", sp.sympify(self.pitch))

    @property
    def key(self) -> str:
        """The neutral lower-case name: the end of `offset_a1`, `lower_a1`."""
        return self.name.lower()

    @property
    def motor(self) -> sp.Symbol:
        """The motor value: axis value less offset. Without gear coupling it is the joint value."""
        return real(f"motor_{self.key}")

    @property
    def is_angle(self) -> bool:
        """Whether axis values are degrees."""
        return self.kind is not Kind.LINEAR

    @property
    def unit(self) -> sp.Expr:
        """One unit of the axis value in units of the joint value."""
        return DEGREE if self.is_angle else sp.Integer(1)

    @property
    def axis(self) -> sp.Symbol:
        """The axis value as the controller has it (degrees or user's length unit)."""
        return real(f"axis_{self.key}")

    @property
    def reference(self) -> sp.Symbol:
        """The reference value of the axis."""
        return real(f"ref_{self.key}")

    @property
    def turn(self) -> sp.Symbol:
        """The commanded period number: 0 where it is open."""
        return real(f"turn_{self.key}")

    @property
    def offset(self) -> sp.Symbol:
        """The parameter `offset_…`: the axis value at joint value zero."""
        return real(f"offset_{self.key}")


class Role(Enum):
    """What a parameter is: decides unit, type and default."""

    LENGTH = "length"
    DISTANCE = "distance"
    """A length that may be zero or negative."""
    PITCH = "pitch"
    GEAR = "gear"
    COUPLING = "coupling"
    RATIO = "ratio"
    FLAG = "flag"
    SIGN = "sign"
    ANGLE = "angle"


@dataclass(frozen=True)
class Parameter(Quantity):
    """An input of the machine. A length has no default: a forgotten one must not move a machine."""

    name: str
    role: Role
    meaning: str
    unit: str
    low: float
    high: float
    low_open: bool
    """The interval is ]low .. high] instead of [low .. high]."""
    default: float | None
    nominal: float
    """For drawings and tests."""
    is_public: bool = True

    @property
    def has_vendor_range(self) -> bool:
        """Whether the upper end is the vendor's and not merely the largest input."""
        return self.high < 1e9


@dataclass(frozen=True)
class Branch:
    """Two solutions told apart by the sign of an indicator: byte 1 is names[0], byte 2 names[1]."""

    name: str
    indicator: sp.Expr
    names: tuple[str, str]
    signs: tuple[int, int]
    margin: str
    """What the singularity is called where its two solutions meet."""


@dataclass(frozen=True)
class Assembly:
    """The two ways to assemble a closed loop, told apart by the sign of an indicator in joints and position.

    The assembly mode is a parameter of the machine, `<name>_<second>`: forward kinematics gets axes alone.
    """

    name: str
    indicator: sp.Expr
    names: tuple[str, str]
    signs: tuple[int, int]
    margin: str
    handedness: sp.Expr = sp.Integer(1)
    """Made of parameters: where it is negative (legs numbered the other way round) the indicator's sign is reversed."""

    @property
    def parameter(self) -> str:
        """The flag that chooses the second way."""
        return f"{self.name}_{self.names[1]}"


@dataclass(frozen=True)
class Rod:
    """A rigid rod of a loop: its end on the base side (moved by joints), its end on the plate, its length."""

    name: str
    base: tuple[sp.Expr, ...]
    plate: tuple[sp.Expr, ...]
    length: sp.Expr

    @property
    def equation(self) -> sp.Expr:
        """|plate - base|^2 - length^2."""
        return sp.Add(*[(p - b) ** 2 for p, b in zip(self.plate, self.base, strict=True)]) - self.length**2


@dataclass(frozen=True)
class Bound:
    """A quantity of joints and position that must not exceed a size (the swing of a ball joint)."""

    value: sp.Expr
    largest: sp.Expr
    meaning: str


@dataclass(frozen=True)
class Limited:
    """A quantity with limits of its own that no axis can see (relative elbow, X of an H-gantry)."""

    name: str
    value: sp.Expr
    is_angle: bool
    meaning: str


@dataclass(frozen=True)
class Constraint:
    """A condition between parameters that Initialize checks."""

    condition: sp.Basic
    message: str


class Turning(Enum):
    """How much of the commanded rotation a mechanism follows."""

    NONE = "none"
    """The rotation is fixed or follows from the position: the commanded one is never read."""
    ABOUT_Z = "about z"
    """One turn about the machine's z: the commanded rotation is projected, tool direction first."""
    FULL = "full"
    """The whole rotation."""


@dataclass(frozen=True)
class Task:
    """What is commanded: "xyz", or "xy" with z met; and how much of the rotation."""

    position: str
    turning: Turning = Turning.NONE


@dataclass(frozen=True)
class Mechanism:
    """A mechanism: its equations, and what its quantities mean. Derivation reads nothing else."""

    name: str
    vendor: Vendor
    family: str
    source: str
    summary: str
    joints: tuple[Joint, ...]
    task: Task
    parameters: tuple[Parameter, ...] = ()
    chain: Chain | None = None
    closure: tuple[sp.Expr, ...] = ()
    rods: tuple[Rod, ...] = ()
    """Closure equations that say that a rod is rigid."""
    assembly: Assembly | None = None
    home: tuple[sp.Expr, ...] = ()
    """Where an iterative forward kinematics starts: x, y, z, then roll, pitch and yaw in radians (Rz Ry Rx)."""
    bounds: tuple[Bound, ...] = ()
    branches: tuple[Branch, ...] = ()
    positive: tuple[sp.Expr, ...] = ()
    """Quantities whose negative mirror solution the machine does not have."""
    limited: tuple[Limited, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    periods: tuple[str, ...] | None = None
    """The multi-turn axes in the order of their configuration bytes; None: the order of the axes."""
    aliases: tuple[str, ...] = ()
    title: str | None = None
    """What GetKinematicsName answers; None: the name of the block."""
    class_name: str | None = None
    offset_interface: bool = True
    """Whether positions of a point off the flange can be commanded (orientation mode "Axis")."""
    notes: tuple[str, ...] = field(default=())
    """Sentences for the user's documentation: what is our definition, what to know."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "positive", tuple(sp.sympify(v) for v in self.positive))
        object.__setattr__(self, "closure", tuple(sp.sympify(v) for v in self.closure))
        object.__setattr__(self, "home", tuple(sp.sympify(v) for v in self.home))

    @property
    def equations(self) -> tuple[sp.Expr, ...]:
        """All stated closure equations."""
        return (*self.closure, *(rod.equation for rod in self.rods))

    @property
    def block_name(self) -> str:
        """The function block: the vendor's name, but never one that CODESYS itself ships."""
        return self.name.replace("Kin_", "Softkin_", 1) if self.vendor is Vendor.CODESYS else self.name

    @property
    def period_joints(self) -> tuple[Joint, ...]:
        """The multi-turn joints in the order of their configuration bytes."""
        turning = {j.name: j for j in self.joints if j.multi_turn}
        return tuple(turning[n] for n in self.periods) if self.periods is not None else tuple(turning.values())


class JointDetails(TypedDict, total=False):
    """What a description may add to a joint; see `Joint`."""

    offset_range: Interval
    limit_range: Interval
    coupling: sp.Expr
    pitch: sp.Expr
    domain: Interval
    nominal: float


def rotary(name: str, meaning: str, **details: Unpack[JointDetails]) -> Joint:
    """A rotary joint with a period byte: its type allows more than 360 degrees."""
    return Joint(_joint_symbol(name), name, Kind.ROTARY, meaning, multi_turn=True, **details)


def arc(name: str, meaning: str, **details: Unpack[JointDetails]) -> Joint:
    """A rotary joint that never turns round: no period byte."""
    return Joint(_joint_symbol(name), name, Kind.ROTARY, meaning, multi_turn=False, **details)


def helical(name: str, meaning: str, **details: Unpack[JointDetails]) -> Joint:
    """A joint that turns and carries another axis along: declared Linear, values in degrees."""
    return Joint(_joint_symbol(name), name, Kind.HELICAL, meaning, multi_turn=True, **details)


def linear(name: str, meaning: str, **details: Unpack[JointDetails]) -> Joint:
    """A linear joint."""
    return Joint(_joint_symbol(name), name, Kind.LINEAR, meaning, **details)


def _joint_symbol(name: str) -> sp.Symbol:
    """The joint value's symbol; x, y and z are taken by the pose."""
    key = name.lower()
    return real(f"joint_{key}" if key in COORDINATE_NAMES else key)


def length(name: str, meaning: str, *, nominal: float, high: float = 1e9) -> Parameter:
    """A length that must be given and be more than zero."""
    symbol = sp.Symbol(name, positive=True)
    return Parameter(symbol, name, Role.LENGTH, meaning, "u", 0.0, high, True, None, nominal)


def optional_length(name: str, meaning: str, *, nominal: float, high: float = 1e9) -> Parameter:
    """A length that may be zero, and is when not given."""
    symbol = sp.Symbol(name, nonnegative=True)
    return Parameter(symbol, name, Role.DISTANCE, meaning, "u", 0.0, high, False, 0.0, nominal)


def pitch(name: str, meaning: str, *, nominal: float, low: float = -1e9, high: float = 1e9) -> Parameter:
    """A travel per revolution, zero when not given."""
    return Parameter(real(name), name, Role.PITCH, meaning, "u/rev", low, high, False, 0.0, nominal)


def gear(name: str, meaning: str, *, nominal: float) -> Parameter:
    """A travel per degree, zero when not given."""
    return Parameter(real(name), name, Role.GEAR, meaning, "u/deg", -1e9, 1e9, False, 0.0, nominal)


def coupling(name: str, meaning: str, *, nominal: float) -> Parameter:
    """A ratio of one motor's turn to another joint's turn, zero when not given."""
    return Parameter(real(name), name, Role.COUPLING, meaning, "1", -1e3, 1e3, False, 0.0, nominal)


def angle(
    name: str, meaning: str, *, nominal: float, low: float = -360.0, high: float = 360.0, default: float | None = None
) -> Parameter:
    """An angle of the machine, in degrees; `radians(p)` inside expressions."""
    return Parameter(real(name), name, Role.ANGLE, meaning, "deg", low, high, False, default, nominal)


def coordinate(name: str, meaning: str, *, nominal: float) -> Parameter:
    """A coordinate of a point, with a sign, that must be given."""
    return Parameter(real(name), name, Role.DISTANCE, meaning, "u", -1e9, 1e9, False, None, nominal)


def distance(name: str, meaning: str, *, nominal: float, low: float = -1e9) -> Parameter:
    """A length with a sign, zero when not given."""
    return Parameter(real(name), name, Role.DISTANCE, meaning, "u", low, 1e9, False, 0.0, nominal)


def radians(parameter: Parameter) -> sp.Expr:
    """An angle parameter as it stands in sines and cosines."""
    return parameter * DEGREE


def flag(name: str, meaning: str, *, nominal: bool = False) -> Parameter:
    """A choice that is off when not given; 0 or 1 inside expressions."""
    symbol = sp.Symbol(name, nonnegative=True)  # its square is itself: see algebra.reduce_units
    return Parameter(symbol, name, Role.FLAG, meaning, "", 0.0, 1.0, False, 0.0, float(nominal))


def sign(name: str, meaning: str, *, nominal: int = 1) -> Parameter:
    """A direction: +1 or -1."""
    symbol = sp.Symbol(name, real=True, nonzero=True)  # its square is one
    return Parameter(symbol, name, Role.SIGN, meaning, "", -1.0, 1.0, False, 1.0, float(nominal))


def branch(name: str, indicator: object, *, margin: str | None = None, **names: int) -> Branch:
    """A branch by its indicator: `branch("elbow", sin(A2), right=+1, left=-1)`; the first name is byte 1."""
    first, second = _two_names(f"branch {name!r}", names)
    return Branch(name, sp.sympify(indicator), (first[0], second[0]), (first[1], second[1]), margin or name)


def assembly(name: str, indicator: object, *, margin: str, handedness: object = 1, **names: int) -> Assembly:
    """Two assembly modes: `assembly("tcp", Y - KNEE_Y, margin="arms_aligned", below=-1, above=+1)`; the first is the default."""
    first, second = _two_names(f"assembly {name!r}", names)
    return Assembly(name, sp.sympify(indicator), (first[0], second[0]), (first[1], second[1]), margin, sp.sympify(handedness))


def rod(name: str, base: Sequence[object], plate: Sequence[object], length: object) -> Rod:
    """A rigid rod between a point that joints move and a point of the plate."""
    return Rod(name, tuple(map(sp.sympify, base)), tuple(map(sp.sympify, plate)), sp.sympify(length))


def on_plate(x: object, y: object, z: object) -> tuple[sp.Expr, ...]:
    """Where a point of the plate is, by its coordinates in the frame of the plate."""
    return tuple(sp.Matrix([X.symbol, Y.symbol, Z.symbol]) + ROTATION * sp.Matrix([x, y, z]))


def bound(value: object, largest: object, meaning: str) -> Bound:
    """|value| must not exceed `largest`."""
    return Bound(sp.sympify(value), sp.sympify(largest), meaning)


def _two_names(what: str, names: dict[str, int]) -> tuple[tuple[str, int], tuple[str, int]]:
    if len(names) != 2 or sorted(names.values()) != [-1, 1]:
        raise DescriptionError(f"{what} needs two names with the signs +1 and -1, not {names}")
    first, second = names.items()
    return first, second


def limited(name: str, value: object, meaning: str, *, angle: bool) -> Limited:
    """A quantity with limits of its own, in radians or lengths."""
    return Limited(name, sp.sympify(value), angle, meaning)
