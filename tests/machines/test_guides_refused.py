"""Guides that do not hold a platform are refused; what the task does not command is explained step by step."""

from dataclasses import replace

import pytest
import sympy as sp

from derive.command.explain import explanation
from derive.description.mechanism import DescriptionError, Task, Turning, X, guide, on_plate
from derive.description.validate import validate
from derive.kinematics.build import build
from tests.machines.guided import GUIDED

RPS = GUIDED["3-RPS on a raised base"]
RINGS = GUIDED["pentapod, whose struts end on the spindle and on rings around it"]


def test_the_steps_for_what_is_not_commanded_are_explained() -> None:
    told = list(explanation(RPS))
    first, second = (told.index(t) for t in ("What the task does not command: x, y, twist", "Inverse kinematics"))
    assert told[first + 1].startswith("  1. twist <- trigonometric <- ")
    assert sum(" <- " in line for line in told[first:]) == 6 and sum(" <- " in line for line in told[first:second]) == 3


WRONG = {
    "a guide too few": (
        replace(RPS, guides=RPS.guides[:2]),
        "the platform moves 6 quantities, and the task commands all but x, y, twist: as many guides without joints "
        "must hold the others, and there are 2",
    ),
    "guides that leave something open": (
        replace(RPS, guides=(*RPS.guides[:2], guide("3", (1, 0, 0), (X, 0, 0)))),
        "guide '3': its point must be a point of the plate",
    ),
    "parallel guides in one place": (
        replace(RPS, guides=tuple(guide(str(k), (0, 1, 0), on_plate(0, 0, 0)) for k in range(3))),
        "the task commands 'z', and the loop moves x, y, twist as well: its guides do not hold that",
    ),
    "a guide that a joint turns": (
        replace(RPS, guides=(*RPS.guides[:2], guide("3", (sp.sin(RPS.joints[0].symbol), 1, 0), on_plate(0, 0, 0)))),
        "the closure has 4 equations, and the task commands only 3 quantities (z, tilt x, tilt y)",
    ),
    "a guide with two coordinates and three": (None, "guide '1': its normal and its point have 3 and 2 coordinates"),
    "a home pose of the task alone": (replace(RPS, home=(450, 0, 0)), "needs a home pose of 6 coordinates, and has 3"),
    "no guides": (replace(RPS, guides=()), "must be held by guides=, planes in which points of a platform that turns"),
    "a ring whose rod begins at a slide": (
        replace(
            RINGS,
            rods=(
                replace(RINGS.rods[0], base=(sp.Integer(0), RINGS.joints[0].symbol, sp.Integer(900))),
                *RINGS.rods[1:],
            ),
        ),
        "rod '1': a rod that ends on a ring begins at a fixed point, and its platform is commanded a direction",
    ),
    "a ring beside a rod that feels the twist": (
        replace(RINGS, rods=(*RINGS.rods[:4], replace(RINGS.rods[4], plate=on_plate(9, 0, 0), ring=None))),
        "only where guides hold what is not commanded, or no rod feels a turn about it",
    ),
    "a whole rotation": (
        replace(RPS, task=Task("z", Turning.FULL)),
        "the task commands 4 quantities (z, turn x, turn y, turn z), and there are only 3 joints",
    ),
}


@pytest.mark.parametrize("what", WRONG)
def test_what_guides_do_not_hold_is_refused(what: str) -> None:
    wrong, sentence = WRONG[what]
    with pytest.raises(DescriptionError) as refused:
        if wrong is None:
            guide("1", (0, 0, 1), on_plate(1, 2))
        else:
            build(validate(wrong))
    assert sentence in str(refused.value)
