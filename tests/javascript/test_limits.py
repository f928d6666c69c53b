"""Limits and turns: a mapping with open ends, what the machine says of them, and the turn that would be inside."""

from __future__ import annotations

from typing import Any

import pytest
import softkin

from tests.corpus.dimensions import DIMENSIONS
from tests.javascript.modules import module_of
from tests.javascript.node import ask

NAME = "Kin_Scara4_ZCcoupled_Type1"
LIMITS: list[dict[str, Any]] = [
    {"A1": [-170.0, 170.0]}, {"A1": [None, 90.0]}, {"A1": [-90.0, None], "A3": [None, None]}, {"A2": None},
    {"A4": [None, 300.0]}, {"A4": [200.0, 700.0]}, {"A1": [-350.0, -300.0], "A3": [-50.0, 50.0]},
]  # fmt: skip
WRONG: list[Any] = [
    {"A9": [0.0, 1.0]}, {"A1": [1.0, 0.0]}, {"A1": [0.0]}, {"A1": "ab"}, {"A1": 3.0}, {"A1": [-1000.0, 0.0]}, 5.0,
]  # fmt: skip


@pytest.mark.parametrize("limits", LIMITS, ids=str)
def test_limits_as_a_mapping(limits: Any) -> None:
    """Every solution of poses on several turns is that of Python, and so is every refusal."""
    robot = softkin.catalogue()[NAME](**DIMENSIONS[NAME], limits=limits)
    poses = [(20.0 + 37.0 * k, 40.0 - 61.0 * k, 7.0 * k, 113.0 * k) for k in range(-8, 9)]
    frames = [robot.forward(axes)[0] for axes in poses]
    turns = [[1, 0, 0, 0], [0, 0, 0, 0], [2, 2, 1, -1]]
    asked = [(frame, given, axes) for frame, axes in zip(frames, poses, strict=True) for given in turns]
    calls = [["inverse", {"position": f.position, "rotation": f.rotation}, given, axes] for f, given, axes in asked]
    machine = {"parameters": DIMENSIONS[NAME], "limits": limits, "calls": calls}
    answer = ask(module_of(NAME), [machine])["answers"][0]
    refused = 0
    for (frame, given, axes), found in zip(asked, answer["found"], strict=True):
        why = robot.diagnose(frame, given, axes)
        assert found["status"] == int(why.status)
        if why.status is softkin.Status.OK:
            assert found["axes"] == pytest.approx(robot.inverse(frame, given, axes), abs=1e-9)
        else:
            refused += 1
            assert f"{found['reason']} [{found['unit']}]" == why.reason and found["turn"] == why.turn
            assert found["missing"] == pytest.approx(why.missing, abs=1e-9)
    assert refused or "A2" in limits
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
