"""Which poses of a sweep each core is asked: a share of many, which is less in Python."""

import os

IS_NATIVE = os.environ["SOFTKIN_CORE"] == "native"
MOST, MOST_SEARCHED = (4000, 4000) if IS_NATIVE else (400, 100)
STEPS = (1, 3, 5, 7, 13, 23, 47, 97)
"""Primes, so that a share has every joint at each of four right angles, and every way from a corner."""


def share(count: int, most: int = MOST) -> slice:
    """The rows that are asked of so many."""
    return slice(None, None, next(step for step in STEPS if count <= most * step))
