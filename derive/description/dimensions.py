"""The dimensions of a machine: the parameters of a description by their roles, and conditions between them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import sympy as sp

from derive.description.quantity import Quantity
from derive.ir.constants import DEGREE, LARGEST
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, ROTATION_ENTRIES, real

_OF_REACHES = ("side_12", "side_13", "side_23", "equal_power", "reach")
_OF_EQUATIONS = {
    *(*COORDINATE_NAMES, DEGREE.name, "corner_area"),
    *(f"{word}_{c}" for word in ("joint", *_OF_REACHES) for c in COORDINATE_NAMES),
    *(f"{word}_{k}" for word in ("power", "weight", "reach", "reach_x", "reach_y") for k in (1, 2, 3)),
    *(r.name for r in ROTATION_ENTRIES),
}
"""Names that equations, and conditions on reaches, give to other values."""


_LARGEST = float(LARGEST)


class Role(Enum):
    """The role of a parameter, which decides its unit, type and default."""

    LENGTH = "length"
    SIGNED_LENGTH = "signed length"
    """A length that may be negative, but not zero."""
    DISTANCE = "distance"
    """A length that may be zero or negative."""
    PITCH = "pitch"
    GEAR = "gear"
    COUPLING = "coupling"
    RATIO = "ratio"
    TRANSMISSION = "transmission"
    """A ratio of turns, of either sign, but not zero."""
    FLAG = "flag"
    SIGN = "sign"
    ANGLE = "angle"


@dataclass(frozen=True)
class Parameter(Quantity):
    """An input of the machine. A length of a geometry has no default: a forgotten one must not move a machine."""

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
    """The value in the machine that is drawn, shown and tested: the default if the description states one."""
    fixed: sp.Expr | None = None
    """The value of a number that stands in a chain. It has a name, but is no input of the machine."""
    given: str = ""
    """Its name in the description, where the derivation uses another name."""
    usual: tuple[float, float] | None = None
    """The range that a vendor states, which is shown where values are entered; values beyond it are not refused."""
    deviation: float | None = None
    """Its value in the machine that is tested, of a deviation: the machine that is drawn and shown has none."""

    @property
    def shown(self) -> tuple[float, float]:
        """The range that is shown where values are entered."""
        return self.usual or (self.low, self.high)

    @property
    def tested(self) -> float:
        """The value in the machine that is tested."""
        return self.nominal if self.deviation is None else self.deviation

    @property
    def given_name(self) -> str:
        """Its name in the description."""
        return self.given or self.name


def _value_of(name: str) -> sp.Symbol:
    """The symbol of a value of either sign."""
    return real(_symbol_name(name))


def _shown(nominal: float, default: float | None) -> float:
    """The value that is shown: a machine for which the description states a default has that value."""
    return nominal if default is None else default


def _symbol_name(name: str) -> str:
    """The name of the symbol: it differs from the coordinates of the pose, even where the parameter's name does not."""
    return f"given {name}" if name in _OF_EQUATIONS else name


def length(name: str, meaning: str, *, nominal: float, high: float = 1e9, default: float | None = None) -> Parameter:
    """A length greater than zero. It must be given, unless the description is of one machine and states a default.

    high: the largest length that the vendor states, which is shown where values are entered; here as in the other
    functions no longer one is refused.
    """
    symbol = sp.Symbol(_symbol_name(name), positive=True)
    shown = _shown(nominal, default)
    usual = (0.0, high)
    return Parameter(symbol, name, Role.LENGTH, meaning, "u", 0.0, _LARGEST, True, default, shown, usual=usual)


def optional_length(name: str, meaning: str, *, nominal: float, high: float = 1e9) -> Parameter:
    """A length that may be zero, and is zero when not given."""
    symbol = sp.Symbol(_symbol_name(name), nonnegative=True)
    usual = (0.0, high)
    return Parameter(symbol, name, Role.DISTANCE, meaning, "u", 0.0, _LARGEST, False, 0.0, nominal, usual=usual)


def signed_length(name: str, meaning: str, *, nominal: float) -> Parameter:
    """A length of either sign, as in tables of Denavit-Hartenberg parameters: it must be given and not be zero."""
    symbol = sp.Symbol(_symbol_name(name), real=True, nonzero=True)
    return Parameter(symbol, name, Role.SIGNED_LENGTH, meaning, "u", -1e9, 1e9, False, None, nominal)


def pitch(name: str, meaning: str, *, nominal: float, low: float = -1e9, high: float = 1e9) -> Parameter:
    """A travel per revolution, zero when not given."""
    ends, usual = (-_LARGEST, _LARGEST), (low, high)
    return Parameter(_value_of(name), name, Role.PITCH, meaning, "u/rev", *ends, False, 0.0, nominal, usual=usual)


def gear(name: str, meaning: str, *, nominal: float) -> Parameter:
    """A travel per degree, zero when not given."""
    return Parameter(_value_of(name), name, Role.GEAR, meaning, "u/deg", -1e9, 1e9, False, 0.0, nominal)


def coupling(name: str, meaning: str, *, nominal: float) -> Parameter:
    """A ratio of one motor's turn to another joint's turn, zero when not given."""
    return Parameter(_value_of(name), name, Role.COUPLING, meaning, "1", -1e3, 1e3, False, 0.0, nominal)


def transmission(name: str, meaning: str, *, nominal: float) -> Parameter:
    """A ratio of turns, of either sign, as of a gear or a belt: it must be given and not be zero."""
    symbol = sp.Symbol(_symbol_name(name), real=True, nonzero=True)
    return Parameter(symbol, name, Role.TRANSMISSION, meaning, "1", -1e6, 1e6, False, None, nominal)


def angle(
    name: str, meaning: str, *, nominal: float, low: float = -360.0, high: float = 360.0, default: float | None = None
) -> Parameter:
    """An angle of the machine, in degrees; `radians(p)` inside expressions."""
    shown = _shown(nominal, default)
    return Parameter(_value_of(name), name, Role.ANGLE, meaning, "deg", low, high, False, default, shown)


def coordinate(name: str, meaning: str, *, nominal: float) -> Parameter:
    """A coordinate of a point, with a sign, that must be given."""
    return Parameter(_value_of(name), name, Role.DISTANCE, meaning, "u", -1e9, 1e9, False, None, nominal)


def distance(name: str, meaning: str, *, nominal: float, low: float = -1e9, default: float | None = None) -> Parameter:
    """A length with a sign; when not given it is zero, or the default that the description of one machine states."""
    given, shown = default or 0.0, _shown(nominal, default)
    return Parameter(_value_of(name), name, Role.DISTANCE, meaning, "u", low, 1e9, False, given, shown)


def radians(angle: Parameter | float) -> sp.Expr:
    """An angle in degrees, a parameter or a number, in radians, as sines and cosines take it."""
    return angle * DEGREE


def flag(name: str, meaning: str, *, nominal: bool = False) -> Parameter:
    """A choice that is off when not given; 0 or 1 inside expressions."""
    symbol = sp.Symbol(_symbol_name(name), nonnegative=True)  # its square is itself: see algebra.reduce_units
    return Parameter(symbol, name, Role.FLAG, meaning, "", 0.0, 1.0, False, 0.0, float(nominal))


def sign(name: str, meaning: str, *, nominal: int = 1) -> Parameter:
    """A direction: +1 or -1."""
    symbol = sp.Symbol(_symbol_name(name), real=True, nonzero=True)  # its square is one
    return Parameter(symbol, name, Role.SIGN, meaning, "", -1.0, 1.0, False, 1.0, float(nominal))


@dataclass(frozen=True)
class Constraint:
    """A condition between parameters that Initialize checks."""

    condition: sp.Basic
    message: str
    steps: tuple[Let, ...] = ()
    """Statements that bind names for this condition and the following ones."""
