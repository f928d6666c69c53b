"""Dimensions that no machine has: as small, as large and as unequal as the ranges permit, and beyond them."""

import random
from collections.abc import Iterator

from derive.description.mechanism import Mechanism, Role
from derive.ir.constants import LEAST

_SIZED = (Role.LENGTH, Role.SIGNED_LENGTH, Role.DISTANCE, Role.TRANSMISSION, Role.PITCH, Role.GEAR, Role.COUPLING)
_LENGTHS = (Role.LENGTH, Role.SIGNED_LENGTH, Role.DISTANCE)
_JUST_ALLOWED = 1.0000001 * float(LEAST)


def extreme_dimensions(mechanism: Mechanism, count: int) -> Iterator[dict[str, float]]:
    """Values of the parameters of a description, the same in every run.

    First the nominal machine as small and as large as the ranges permit, then `count` machines whose dimensions have
    nothing in common, but that some are equal or nearly so.
    """
    sizes = [abs(p.nominal) for p in mechanism.parameters if p.role in _LENGTHS and p.nominal]
    highest = min((p.high / p.nominal for p in mechanism.parameters if p.role in _LENGTHS and p.nominal > 0), default=1)
    for scale in (_JUST_ALLOWED / min(sizes, default=1.0), highest):
        yield {p.name: p.nominal * (scale if p.role in _LENGTHS else 1.0) for p in mechanism.parameters}
    rng = random.Random(mechanism.name)
    for _ in range(count):
        same, given = _size(rng), {}
        for p in mechanism.parameters:
            if p.role not in _SIZED:
                given[p.name] = p.nominal
                continue
            value = rng.choice([_size(rng), same, same * (1 + 2**-52), same * (1 - 2**-53)])
            given[p.name] = -value if p.low < 0 and rng.random() < 0.5 else value
        yield given


def _size(rng: random.Random) -> float:
    """A size between the ends of all ranges, at an end, or one whose products are no numbers."""
    return rng.choice(
        [10 ** rng.uniform(-12, 9), 10 ** rng.uniform(-1, 4), _JUST_ALLOWED, 1e9, 0.0, 1e-150, 1e-300, 5e-324]
    )
