"""Limits and turns: open ends, quantities beside the axes, and the turn that would be inside."""

from __future__ import annotations

from typing import Any

import pytest
import softkin

from tests.c.machine import ask
from tests.c.programs import program_of
from tests.corpus.dimensions import DIMENSIONS
from tests.javascript.test_limits import LIMITS, NAME


@pytest.mark.parametrize("limits", LIMITS, ids=str)
def test_open_ends(limits: Any) -> None:
    """An infinite limit is none on its side: every solution and every refusal is that of Python with None there."""
    robot = softkin.catalogue()[NAME](**DIMENSIONS[NAME], limits=limits)
    poses = [(20.0 + 37.0 * k, 40.0 - 61.0 * k, 7.0 * k, 113.0 * k) for k in range(-8, 9)]
    frames = [robot.forward(axes)[0] for axes in poses]
    turns = [[1, 0, 0, 0], [0, 0, 0, 0], [2, 2, 1, -1]]
    asked = [(frame, given, axes) for frame, axes in zip(frames, poses, strict=True) for given in turns]
    calls = [["inverse", {"position": f.position, "rotation": f.rotation}, given, axes] for f, given, axes in asked]
    given_ends = {f"{word}_{axis.lower()}": end for axis, pair in limits.items()
                  for word, end in zip(("lower", "upper"), _ends(pair), strict=True)}  # fmt: skip
    (answer,) = ask(program_of(NAME), [{"parameters": DIMENSIONS[NAME] | given_ends, "calls": calls}])
    assert answer["made"] == {"status": 0}
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


def _ends(pair: Any) -> tuple[float, float]:
    lower, upper = pair or (None, None)
    return -float("inf") if lower is None else lower, float("inf") if upper is None else upper


def test_the_test_of_limits() -> None:
    """It says the same as the inverse, of axis values that a caller has."""
    given = DIMENSIONS[NAME] | {"lower_a1": -90.0, "upper_a1": 90.0}
    calls = [["limits", [angle, 0.0, 0.0, 0.0]] for angle in (0.0, 90.0, 90.1, -400.0)]
    (answer,) = ask(program_of(NAME), [{"parameters": given, "calls": calls}])
    assert [found["status"] for found in answer["found"]] == [0, 0, 3, 3]
    assert answer["found"][2]["reason"] == "A1: above its upper limit" and answer["found"][2]["unit"] == "deg"
    assert answer["found"][3]["turn"] == 1  # -400 is -40 on the first turn
