"""Refusals that no other test asserts: parts of a wrong kind, texts, turns that are none, machines without a pose."""

import re
from collections.abc import Callable

import pytest
from sympy import sin

from derive import compile_mechanism
from derive.description.mechanism import DescriptionError, Mechanism, Task, Turning, X, Y, rod
from derive.description.validate import validate
from derive.frames import Rz, Tx, Ty, Tz
from derive.kinematics.build import build
from derive.kinematics.refusals.no_pose import why_no_pose
from derive.mechanism import length, linear, rotary
from derive.vectors import vector
from tests.unit.kinematics.inventions import A1, L1
from tests.unit.kinematics.inventions import planar_arm as described

S1, S2, S3 = (linear(name, "slide") for name in ("S1", "S2", "S3"))
RADIUS = linear("R", "radius", domain=(0.0, 50.0))
ROD, WIDE = length("rod_length", "rod", nominal=120.0), length("base", "base", nominal=1800.0)
TURNED = rotary("C", "turn")
P = vector(X, Y)


def loop(**stated: object) -> Mechanism:
    return described(chain=None, branches=(), **stated)


REFUSED: dict[str, tuple[Callable[[], object], str]] = {
    "a quantity that is a text": (
        lambda: described(positive=("2 *",)),
        "positive holds '2 *' (a str), which is no expression",
    ),
    "a nominal value that is a text": (
        lambda: validate(described(joints=(A1, linear("A2", "slide", nominal="3")))),  # type: ignore[arg-type]
        "joint 'A2': its nominal value is '3' (a str), and no number",
    ),
    "a nominal length that is true": (
        lambda: validate(described(parameters=(L1, length("link_2", "link", nominal=True)))),
        "parameter 'link_2': its nominal value is True (a bool), and no number",
    ),
    "a range of one end": (
        lambda: validate(described(joints=(A1, rotary("A2", "turn", limits=(90.0,))))),  # type: ignore[arg-type]
        "joint 'A2': its limits is (90.0,) (a tuple), and not two numbers: as in limits=(-90.0, 90.0)",
    ),
    "a range of a text": (
        lambda: validate(described(joints=(A1, rotary("A2", "turn", domain=("a", 3.0))))),  # type: ignore[arg-type]
        "joint 'A2': its domain is ('a', 3.0) (a tuple), and not two numbers: as in domain=(-90.0, 90.0)",
    ),
    "a text with a bell": (
        lambda: validate(described(summary="An arm \x07 that rings.")),
        "a line break or a character that is not printed: leave it out",
    ),
    "a heading of a chain that never turns": (
        lambda: build(
            validate(
                described(
                    parameters=(),
                    joints=(S1, S2, S3, TURNED),
                    chain=Tx(S1) * Ty(S2) * Tz(S3) * Tx(TURNED),
                    task=Task("xyz", Turning.ABOUT_Z),
                    branches=(),
                )
            )
        ),
        "its rotation is not one turn about z, it does not turn at all; command the whole rotation, or a direction",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_refused(what: str) -> None:
    call, sentence = REFUSED[what]
    with pytest.raises(DescriptionError, match=re.escape(sentence)):
        call()


NOWHERE: dict[str, tuple[Mechanism, str]] = {
    "an equation that nothing solves": (
        loop(parameters=(ROD,), joints=(S1, S2), closure=(X - S1, (Y - S2) ** 2 + ROD**2)),
        "with nominal dimensions the loop never closes: at best equation 2 of the closure misses zero by 1.44e+04; "
        "check the nominal values of parameters",
    ),
    "rods that a joint makes longer, and not long enough": (
        loop(
            parameters=(ROD, WIDE),
            joints=(A1, S1),
            rods=(rod("1", (0, 0), P, ROD * sin(A1)), rod("2", (WIDE, 0), P, ROD * sin(A1))),
        ),
        "rod '1', which changes its length, misses ",
    ),
    "a joint whose values are bounded": (
        described(parameters=(), joints=(A1, RADIUS), chain=Rz(A1) * Tx(RADIUS), branches=()),
        "no pose is possible where the joints may be (R from 0 to 50): check the nominal values of parameters",
    ),
    "nothing that could be the reason": (
        described(),
        "no sampled pose is possible: check the nominal values of parameters",
    ),
}


@pytest.mark.parametrize("what", NOWHERE)
def test_why_there_is_no_pose(what: str) -> None:
    mechanism, sentence = NOWHERE[what]
    assert sentence in why_no_pose(mechanism)


def test_what_is_no_description() -> None:
    with pytest.raises(TypeError, match="compile_mechanism takes a Mechanism, or the path of its file, not 3"):
        compile_mechanism(3)  # type: ignore[arg-type]
