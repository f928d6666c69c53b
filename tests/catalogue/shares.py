"""Which poses of a sweep each core is asked: the native one all, the one in Python, which is slower, a fifth of many.

Both answer by the same program, which the tests of the native half show.
"""

from __future__ import annotations

import os

IS_NATIVE = os.environ["SOFTKIN_CORE"] == "native"
EACH = 5
"""It is odd: in a share of a grid of four right angles no joint stands still."""
MANY = 2000


def share(count: int) -> slice:
    """The rows that are asked of so many."""
    return slice(None, None, 1 if IS_NATIVE or count < MANY else EACH)
