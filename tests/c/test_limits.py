"""Limits and turns: open ends, quantities beside the axes, and the turn that would be inside."""

from typing import Any

import pytest

from tests.c.machine import ask
from tests.c.programs import program_of
from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.limited import LIMITS, NAME, limited


@pytest.mark.parametrize("limits", LIMITS, ids=str)
def test_open_ends(limits: Any) -> None:
    """An infinite limit is none on its side: every solution and every refusal is that of Python with None there."""
    machine = limited(limits)
    given_ends = {f"{word}_{axis.lower()}": end for axis, pair in limits.items()
                  for word, end in zip(("lower", "upper"), _ends(pair), strict=True)}  # fmt: skip
    given = {"parameters": DIMENSIONS[NAME] | given_ends, "calls": machine.calls}
    (answer,) = ask(program_of(NAME), [given])
    assert answer["made"] == {"status": 0}
    assert machine.confirm(answer["found"]) or "A2" in limits


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
