"""Which poses of a sweep each core is asked: a share of many, which is less in Python."""

import os

MOST = 4000 if os.environ["SOFTKIN_CORE"] == "native" else 200
STEPS = (1, 3, 5, 7, 13, 23, 47, 97, 193)
"""Primes, so that a share has every joint at each of four right angles, and every way from a corner."""


def share(count: int) -> slice:
    """The rows that are asked of so many."""
    return slice(None, None, next(step for step in STEPS if count <= MOST * step))
