"""Calls that are refused, or must be."""

from collections.abc import Callable

import pytest
from softkin import KinematicsError, Status


def refusal(call: Callable[..., object], *arguments: object, says: str | None = None, **given: object) -> Status:
    """The status that a call is refused with; its message is one line. says: a pattern that is in it."""
    with pytest.raises(KinematicsError, match=says) as error:
        call(*arguments, **given)
    message = str(error.value)
    assert message
    assert "\n" not in message
    assert len(message) < 300
    return error.value.status


def status_of(call: Callable[..., object], *arguments: object, **given: object) -> Status:
    try:
        call(*arguments, **given)
    except KinematicsError as refused:
        return refused.status
    return Status.OK
