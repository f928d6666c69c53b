"""Limits and turns: a mapping with open ends, what the machine says of them, and the turn that would be inside."""

from typing import Any

import pytest
import softkin

from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.limited import LIMITS, NAME, limited
from tests.javascript.modules import module_of
from tests.javascript.node import ask

WRONG: list[Any] = [
    {"A9": [0.0, 1.0]}, {"A1": [1.0, 0.0]}, {"A1": [0.0]}, {"A1": "ab"}, {"A1": 3.0}, {"A1": [-2e9, 0.0]}, 5.0,
]  # fmt: skip


@pytest.mark.parametrize("limits", LIMITS, ids=str)
def test_limits_as_a_mapping(limits: Any) -> None:
    """Every solution of poses on several turns is that of Python, and so is every refusal."""
    machine = limited(limits)
    asked = {"parameters": DIMENSIONS[NAME], "limits": limits, "calls": machine.calls}
    answer = ask(module_of(NAME), [asked])["answers"][0]
    assert machine.confirm(answer["found"]) or "A2" in limits
    ends = {one["name"]: (one["lower"], one["upper"]) for one in answer["limits"]}
    assert ends["A2"] == (None, None)
    assert all(ends[name] == (tuple(given) if name != "A4" else ends[name]) for name, given in limits.items() if given)
    assert all(end is not None and abs(end) <= 720.0 for end in ends["A4"])


@pytest.mark.parametrize("limits", WRONG, ids=str)
def test_limits_that_are_none(limits: Any) -> None:
    """Python and JavaScript both refuse them."""
    with pytest.raises(softkin.KinematicsError):
        softkin.catalogue()[NAME](**DIMENSIONS[NAME], limits=limits)
    machine = {"parameters": DIMENSIONS[NAME], "limits": limits, "calls": []}
    made = ask(module_of(NAME), [machine])["answers"][0]["made"]
    assert made["status"] == 1 and made["reason"]
