"""Values that are typed into fields: poses, dimensions and limits, and how they are refused."""

from math import isclose
from typing import Any

import numpy as np
import pytest
import softkin

from tests.view.states import Seen, confirm, robot_of

pytestmark = pytest.mark.slow


def test_a_refusal_is_told(seen: Seen) -> None:
    """The sentence of `diagnose` with its amount, and the part of the machine that refuses is marked."""
    refused = seen["refused"]
    target = softkin.Frame.from_euler(*(float(t) for t in refused["shownTool"][3:]), refused["frame"]["position"])
    asked = softkin.Frame((700.0, *refused["frame"]["position"][1:]), target.rotation)
    told = robot_of(refused).diagnose(asked, refused["branches"], reference=refused["axes"])
    assert told is not None
    assert refused["refusal"] == told.in_words
    assert told.in_words.startswith("A2: out of reach, missing ")
    assert refused["isMarked"]
    assert refused["axes"] == [20, 40, 5, 30]
    assert seen["reached"]["refusal"] is None
    assert not seen["reached"]["isMarked"]
    assert isclose(seen["reached"]["frame"]["position"][0], 400, abs_tol=1e-9)
    confirm(seen["reached"])


def test_dimensions_are_edited(seen: Seen) -> None:
    """A length of 0 is refused in a sentence, and leaves the machine as it was; another one changes it."""
    assert len(seen["dimension"]) == 1
    assert "must be more than 0 and at most 1000000000" in seen["dimension"][0]
    assert seen["afterWrong"]["parameters"]["link_length_1"] == 325
    assert seen["longer"]["parameters"]["link_length_1"] == 300
    confirm(seen["longer"])


def test_limits_and_keys(seen: Seen) -> None:
    """An axis beyond its limit is told and marked; arrow keys step by 1 and 10; a branch is chosen by its name."""
    assert seen["beyond"]["refusal"] == "A1: above its upper limit, missing 5.0 deg"
    assert seen["beyond"]["isMarked"]
    assert isclose(seen["stepped"]["axes"][0], 19, abs_tol=1e-9)
    assert seen["stepped"]["refusal"] is None
    assert "A1: above its upper limit" in seen["left"]["refusal"]
    assert len(seen["withoutGhosts"]["ghosts"]) == 0
    assert isclose(seen["away"][1], 0.9 * seen["away"][0], rel_tol=1e-9)
    order = seen["order"]
    assert order[:3] == ["To the values", "machine", "move"]
    assert order.index("canvas") < order.index("axis-0") < order.index("tool-X") < order.index("CSV")


def test_limits_of_a_description(seen: Seen) -> None:
    """Nobody gives them: the page has them from the description, and an axis beyond one is no regular pose."""
    inside, beyond = seen["own"]["inside"], seen["own"]["beyond"]
    assert inside["refusal"] is None and inside["state"] != "refused"
    assert (beyond["state"], beyond["refusal"]) == ("refused", "A1: above its upper limit, missing 50.0 deg")
    assert beyond["isMarked"] and beyond["parameters"]["upper_a1"] == 150


def test_an_end_of_a_limit_is_open(seen: Seen) -> None:
    """Two ends are taken together that are refused one by one; an empty field is no limit, also copied and restored."""
    assert len(seen["lowerAlone"]) == 1 and "lower_a1 below upper_a1" in seen["lowerAlone"][0]
    assert (seen["bothEnds"]["parameters"]["lower_a1"], seen["bothEnds"]["parameters"]["upper_a1"]) == (28, 60)
    found = seen["openEnd"]
    assert found["limits"] == {"A1": [None, 60]} == seen["openEndRestored"]["limits"]
    assert found["axes"][0] == -200 and found["refusal"] is None
    assert seen["endFields"] == [["", "60"], ["", ""]]
    assert seen["noLimit"]["limits"] == {} and seen["noLimit"]["parameters"]["upper_a1"] == 0
    assert seen["upperAlone"]["limits"] == {"A1": [None, 60]}  # where there were no limits, the other end is open
    confirm(found)
    names: dict[str, Any] = {}
    exec(seen["openEndCopied"], names)  # the text of the viewer
    assert names["robot"] == robot_of(found)
    assert np.allclose(names["axes"], found["axes"], rtol=0, atol=1e-9)
