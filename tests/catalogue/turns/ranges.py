"""Ranges of axes, and what the inverse must answer in them: found here by counting turns, not by its formula."""

from collections.abc import Iterator
from dataclasses import dataclass

WIDTHS = (180.0, 340.0, 350.0, 351.0, 360.0, 361.0, 540.0)
GAP_THAT_NO_STEP_CROSSES = 10.0
STEPS = (1e-9, 1e-6, 0.1, 9.0)
"""Degrees; the last one is the longest that a path takes."""
FEW_WIDTHS = (340.0, 350.0, 351.0, 360.0, 540.0)
FEW_STEPS = (1e-6, 9.0)


@dataclass(frozen=True)
class Range:
    """The limits of an axis, in degrees."""

    lower: float
    upper: float

    @property
    def width(self) -> float:
        """From end to end."""
        return self.upper - self.lower

    @property
    def tolerance(self) -> float:
        """How far beyond an end is inside."""
        return 1e-9 * (1.0 + abs(self.lower) + abs(self.upper))

    @property
    def has_one_value(self) -> bool:
        """Whether the gap beyond its ends is one that no step crosses."""
        return self.width <= 360.0 - GAP_THAT_NO_STEP_CROSSES + self.tolerance

    def has(self, value: float) -> bool:
        return self.lower - self.tolerance <= value <= self.upper + self.tolerance

    def is_sharp(self, value: float) -> bool:
        """Whether no value of that direction is where rounding decides if it is inside: next to an end as tolerated."""
        ends = (self.lower - self.tolerance, self.upper + self.tolerance)
        return all(abs(v - end) > 1e-10 for v in _turns(value) for end in ends)

    def inside(self, value: float) -> list[float]:
        """The values inside that are whole turns from a value."""
        return [v for v in _turns(value) if self.has(v)]

    def answer(self, value: float, reference: float) -> float | None:
        """The axis value of a direction where its turn is open; None where it is refused."""
        if self.has_one_value:
            inside = self.inside(value)
            assert len(inside) <= 1
            return inside[0] if inside else None
        nearest = min(_turns(value), key=lambda v: abs(v - reference))
        return nearest if self.has(nearest) else None


def placed(width: float) -> Iterator[Range]:
    """A range around 0, and two beside it."""
    yield Range(-width / 2, width / 2)
    yield Range(77.3 - width, 77.3)
    yield Range(-33.1, width - 33.1)


def number_of(value: float) -> int:
    """The number of the turn of an axis value: 1 is -180 to 180, -1 the turn below; there is no 0."""
    below = 0
    while value >= 180.0 - 1e-9:
        value, below = value - 360.0, below + 1
    while value < -180.0 - 1e-9:
        value, below = value + 360.0, below - 1
    return below + 1 if below >= 0 else below


def _turns(value: float) -> list[float]:
    return [value + 360.0 * k for k in range(-8, 9)]
