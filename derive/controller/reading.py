"""The answer of a source about one axis: a finite number, or the reason why there is none."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from enum import Enum
from reprlib import Repr
from typing import Any

_SHORT = Repr()
_SHORT.maxstring = _SHORT.maxother = 40


class Quality(Enum):
    """How much the value of an axis may be trusted."""

    GOOD = "good"
    STALE = "stale"
    """A number, which no answer has confirmed for a while."""
    BAD = "bad"
    """No number, or a number that the controller itself does not mark as good."""
    MISSING = "missing"
    """No answer yet."""


@dataclass(frozen=True)
class Unusable:
    """The answer of a source that is no number."""

    reason: str


@dataclass(frozen=True)
class Reading:
    """The last answer about an axis."""

    value: float | None
    """In degrees or units of length of the machine; None if the answer is unusable."""
    reason: str
    """The reason why the answer is unusable; empty if it is usable."""
    at: float
    """The time of the answer, in seconds of the clock of the feed."""


def judged(raw: object, scale: float, at: float) -> Reading:
    """The reading of an answer, which may be any object: a finite number times a scale, or the reason why there is
    none.
    """
    if isinstance(raw, Unusable):
        return Reading(None, raw.reason, at)
    if isinstance(raw, bool) or not isinstance(raw, int | float):
        return Reading(None, f"no number: {shown(raw)}", at)
    try:
        value = float(raw) * scale
    except OverflowError:
        return Reading(None, "a number that is too large", at)
    if not math.isfinite(value):
        return Reading(None, f"not finite: {raw}", at)
    return Reading(value, "", at)


def read_json(text: str | bytes, **hooks: Any) -> Any:
    """The value in a text of JSON. hooks: those of `json.loads`. Raises `ValueError`, also where it is too deep."""
    try:
        return json.loads(text, **hooks)
    except RecursionError:
        raise ValueError("it is too deeply nested") from None


def shown(raw: object) -> str:
    """The answer in a few characters."""
    text = _SHORT.repr(raw)
    return text if len(text) <= 40 else f"{text[:37]}..."
