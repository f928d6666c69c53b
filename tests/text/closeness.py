"""Whether two answers are the same to rounding."""

from collections.abc import Callable
from typing import Any

from softkin import KinematicsError

from tests.text.controller import OK, Answer

TOLERANCE = 1e-12
"""Relative to the larger of 1 and the value: both languages evaluate the same formulas."""


def asked(call: Callable[..., Any], *arguments: Any) -> Answer:
    """The answer of a call in Python, as a status and a value."""
    try:
        return OK, call(*arguments)
    except KinematicsError as refusal:
        return refusal.status.softmotion, None


def is_close(found: Any, expected: Any) -> bool:
    """Whether numbers agree to rounding, and everything else exactly."""
    if found == expected:
        return True
    if isinstance(expected, float):
        return abs(found - expected) <= TOLERANCE * max(1.0, abs(expected))
    if isinstance(expected, tuple | list):
        return len(found) == len(expected) and all(map(is_close, found, expected))
    return False


def assert_same(found: Any, expected: Any, *context: object) -> None:
    """Fail where two answers differ, and say what was asked."""
    assert is_close(found, expected), "\n".join(map(str, (f"{found} is not {expected}", *context)))
