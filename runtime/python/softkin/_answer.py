"""Calls that ask several parts: they end at the first part that refuses, with its status or reason."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from softkin._types import Diagnosis, Status

_T = TypeVar("_T")
_P = ParamSpec("_P")


class _Refusal(Exception):
    def __init__(self, why: Any) -> None:
        self.why = why


def answer(found: _T | Status | Diagnosis) -> _T:
    """What was found; where it is a refusal, the call that is `refusing` ends with it."""
    if isinstance(found, Status | Diagnosis):
        raise _Refusal(found)
    return found


def refusing(call: Callable[_P, _T]) -> Callable[_P, _T]:
    """The call, which answers with the first refusal of what it asks."""

    @wraps(call)
    def asked(*args: _P.args, **keywords: _P.kwargs) -> _T:
        try:
            return call(*args, **keywords)
        except _Refusal as refusal:
            found: _T = refusal.why
            return found

    return asked
