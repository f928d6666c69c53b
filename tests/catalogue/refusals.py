"""Calls that must be refused."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from softkin import KinematicsError, Status


def refusal(call: Callable[..., object], *arguments: object) -> Status:
    """The status that a call is refused with; its message is one line, and where it is about values it names the
    mechanism.
    """
    with pytest.raises(KinematicsError) as error:
        call(*arguments)
    message = str(error.value)
    assert message
    assert "\n" not in message
    assert len(message) < 300
    return error.value.status
