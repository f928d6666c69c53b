"""Limits and turns of a SCARA, in C and in JavaScript: open ends, refusals, and the turn that would be inside."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pytest
import softkin

from tests.corpus.dimensions import DIMENSIONS
from tests.languages.language import JAVASCRIPT, LANGUAGES, Answer, C, Language

NAME = "Kin_Scara4_ZCcoupled_Type1"
LIMITS: list[dict[str, Any]] = [
    {"A1": [-170.0, 170.0]}, {"A1": [None, 90.0]}, {"A1": [-90.0, None], "A3": [None, None]}, {"A2": None},
    {"A4": [None, 300.0]}, {"A4": [200.0, 700.0]}, {"A1": [-350.0, -300.0], "A3": [-50.0, 50.0]},
]  # fmt: skip
WRONG: list[Any] = [
    {"A9": [0.0, 1.0]}, {"A1": [1.0, 0.0]}, {"A1": [0.0]}, {"A1": "ab"}, {"A1": 3.0}, {"A1": [-2e9, 0.0]}, 5.0,
]  # fmt: skip
EVERY = pytest.mark.parametrize("limits", LIMITS, ids=str)
TURNS = ([1, 0, 0, 0], [0, 0, 0, 0], [2, 2, 1, -1])


@dataclass(frozen=True)
class Limited:
    """The machine with limits, and what is asked of it: frame, configuration, reference."""

    robot: softkin.Mechanism
    asked: Sequence[tuple[softkin.Frame, list[int], tuple[float, ...]]]

    @property
    def calls(self) -> list[Any]:
        return [["inverse", {"position": f.position, "rotation": f.rotation}, c, axes] for f, c, axes in self.asked]

    def confirm(self, answers: Sequence[Mapping[str, Any]]) -> int:
        """Every solution is that of Python, and so is every refusal; how many are refused."""
        refused = 0
        for (frame, given, axes), found in zip(self.asked, answers, strict=True):
            why = self.robot.diagnose(frame, given, axes)
            assert found["status"] == int(why.status)
            if why.status is softkin.Status.OK:
                assert found["axes"] == pytest.approx(self.robot.inverse(frame, given, axes), abs=1e-9)
            else:
                refused += 1
                assert f"{found['reason']} [{found['unit']}]" == why.reason and found["turn"] == why.turn
                assert found["missing"] == pytest.approx(why.missing, abs=1e-9)
        return refused


def limited(limits: Mapping[str, Any]) -> Limited:
    """Poses on several turns, each with open and with commanded turns."""
    robot = softkin.catalogue()[NAME](**DIMENSIONS[NAME], limits=limits)
    poses = [(20.0 + 37.0 * k, 40.0 - 61.0 * k, 7.0 * k, 113.0 * k) for k in range(-8, 9)]
    return Limited(robot, [(robot.forward(axes)[0], given, axes) for axes in poses for given in TURNS])


@EVERY
def test_infinite_limits_are_none_on_their_side(limits: Any) -> None:
    """In C: every solution and every refusal is that of Python with None there."""
    machine = limited(limits)
    ends = {axis.lower(): pair or (None, None) for axis, pair in limits.items()}
    given = {f"lower_{key}": -float("inf") if low is None else low for key, (low, _) in ends.items()}
    given |= {f"upper_{key}": float("inf") if high is None else high for key, (_, high) in ends.items()}
    answer = answer_in_c({"parameters": DIMENSIONS[NAME] | given, "calls": machine.calls})
    assert answer["made"] == {"status": 0}
    assert machine.confirm(answer["found"]) or "A2" in limits


def answer_in_c(machine: Answer) -> Answer:
    (answer,) = C.ask(C.of_catalogue(NAME), [machine])
    return answer


@EVERY
def test_limits_as_a_mapping(limits: Any) -> None:
    """In JavaScript: every solution of poses on several turns is that of Python, and so is every refusal."""
    machine = limited(limits)
    asked = {"parameters": DIMENSIONS[NAME], "limits": limits, "calls": machine.calls}
    (answer,) = JAVASCRIPT.ask(JAVASCRIPT.of_catalogue(NAME), [asked])
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
    made = JAVASCRIPT.ask(JAVASCRIPT.of_catalogue(NAME), [machine])[0]["made"]
    assert made["status"] == 1 and made["reason"]


def test_the_test_of_limits() -> None:
    """In C it says the same as the inverse, of axis values that a caller has."""
    given = DIMENSIONS[NAME] | {"lower_a1": -90.0, "upper_a1": 90.0}
    calls = [["limits", [angle, 0.0, 0.0, 0.0]] for angle in (0.0, 90.0, 90.1, -400.0)]
    answer = answer_in_c({"parameters": given, "calls": calls})
    assert [found["status"] for found in answer["found"]] == [0, 0, 3, 3]
    assert answer["found"][2]["reason"] == "A1: above its upper limit" and answer["found"][2]["unit"] == "deg"
    assert answer["found"][3]["turn"] == 1  # -400 is -40 on the first turn


@pytest.mark.parametrize("language", LANGUAGES, ids=str)
def test_no_answer_is_larger_than_an_input(language: Language) -> None:
    """Without limits an axis ends where forward kinematics would refuse its value."""
    given = {"offset_x": 9e8}
    robot = softkin.catalogue()["Kin_Gantry2"](**given)
    frames = [softkin.Frame((x, 0.0, 0.0)) for x in (1e8, 1.001e8)]
    calls = [["inverse", {"position": f.position, "rotation": f.rotation}, [], [0.0, 0.0]] for f in frames]
    (answer,) = language.ask(language.of_catalogue("Kin_Gantry2"), [{"parameters": given, "calls": calls}])
    expected = [int(robot.diagnose(frame, (), (0.0, 0.0)).status) for frame in frames]
    assert [found["status"] for found in answer["found"]] == expected == [0, int(softkin.Status.UNREACHABLE)]
