"""The proof on Klipper finds faults in steps: made here for a known way, with and without."""

from __future__ import annotations

import numpy as np
import pytest

from prove.klipper.__main__ import main
from prove.klipper.steps import Steps, compared, crossings, decoded

IDEAL = np.stack((40.0 * np.sin(np.linspace(0.0, 7.0, 20001)), np.linspace(0.0, 60.0, 20001)), axis=1)
"""Two axes along a way: one turns back twice."""


def faultless() -> list[Steps]:
    """Steps of a machine that goes the way at one point in a microsecond."""
    return [Steps(places * 1e-6, directions) for places, directions in map(crossings, IDEAL.T)]


def test_steps_of_the_way_are_within_half_a_step() -> None:
    found = compared(faultless(), IDEAL)
    assert found.fault == "" and 0.4 < found.farthest <= 0.501 and found.count > 200


@pytest.mark.parametrize("late", [300.0, -300.0])
def test_an_axis_that_is_late_is_far(late: float) -> None:
    """By 300 points of the way, which are 0.9 steps of the other axis."""
    steps = faultless()
    assert compared([steps[0], Steps(steps[1].times + late * 1e-6, steps[1].directions)], IDEAL).farthest > 1.0


def test_other_steps_are_a_fault() -> None:
    """One too few, one in the other direction; a step that the next takes back may be missing."""
    first, second = faultless()
    assert compared([first, Steps(second.times[1:], second.directions[1:])], IDEAL).fault
    turned = second.directions.copy()
    turned[5] = -1.0
    assert compared([first, Steps(second.times, turned)], IDEAL).fault
    back = int(np.flatnonzero(np.diff(first.directions))[0])
    rest = [np.delete(values, [back, back + 1]) for values in (first.times, first.directions)]
    assert compared([Steps(*rest), second], IDEAL).fault == ""


def test_messages_are_decoded() -> None:
    """Intervals that grow, directions, and a stepper that is set to another clock."""
    text = """
config_stepper oid=7 step_pin=gpiochip0/gpio2 dir_pin=gpiochip0/gpio3 invert_step=0 step_pulse_ticks=100
set_next_step_dir oid=7 dir=0
queue_step oid=7 interval=100 count=3 add=10
reset_step_clock oid=7 clock=1000
set_next_step_dir oid=7 dir=1
queue_step oid=7 interval=50 count=1 add=0
"""
    none, one = decoded(text, {"gpio0": 0, "gpio2": 1}, 10.0)
    assert len(none.times) == 0
    assert one.times == pytest.approx([10.0, 21.0, 33.0, 105.0]) and one.directions.tolist() == [-1, -1, -1, 1]


def test_steps_of_a_part_are_those_of_its_time() -> None:
    """The first of the next part belongs to that."""
    part = Steps(np.array([1.0, 2.0, 3.0, 4.0]), np.array([1.0, -1.0, 1.0, 1.0])).between(2.0, 4.0)
    assert part.times.tolist() == [2.0, 3.0] and part.directions.tolist() == [-1.0, 1.0]


@pytest.mark.parametrize(("given", "said"), [([], "no checkout of Klipper is given"), (["/nowhere"], "is no checkout")])
def test_without_a_checkout_it_says_so(given: list[str], said: str, capsys: pytest.CaptureFixture[str]) -> None:
    """In a sentence, and with a status of its own."""
    assert main(given) == 3
    told = capsys.readouterr().err
    assert said in told and told.startswith("The proof on Klipper did not run: ") and told.count("\n") == 1
