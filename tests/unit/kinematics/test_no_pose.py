"""Machines whose nominal dimensions leave no pose: the refusal names the rod or the quantity, and comes at once."""

import re
import time
from dataclasses import replace

import pytest
from sympy import cos, sin

from derive.description.catalogue import MECHANISMS, load
from derive.description.mechanism import DescriptionError, Mechanism, Rod, Task, X, Y, length, linear, rod, rotary
from derive.description.validate import validate
from derive.frames import Rz, Tx
from derive.mechanism import assembly, branch
from derive.pipeline import derive_and_measure
from derive.vectors import cross, dot, minus, vector
from derive.witness import Disagreement
from tests.unit.kinematics.inventions import described

A1, A2 = rotary("A1", "turn"), rotary("A2", "turn")
S1, S2 = linear("S1", "slide"), linear("S2", "slide")
RADIUS = linear("R", "radius", domain=(0.0, 50.0))
LINK, OTHER = length("link", "link", nominal=300.0), length("other", "link", nominal=200.0)
ROD, BASE = length("rod_length", "rod", nominal=120.0), length("base", "base", nominal=1800.0)
P = vector(X, Y)


def two_rods(first: Rod, second: Rod, **stated: object) -> Mechanism:
    """A loop of two rods in a plane."""
    one, two = (minus(P, r.base) for r in (first, second))
    ways = [(branch(n, dot(vector(1, 0), v), ahead=+1, behind=-1)) for n, v in (("left", one), ("right", two))]
    mode = assembly("tcp", cross(one, two), margin="aligned", above=+1, below=-1)
    return described(rods=(first, second), task=Task("xy"), branches=tuple(ways), assembly=mode, **stated)


KNEE = vector(LINK * cos(A1), LINK * sin(A1))
OTHER_KNEE = vector(BASE + LINK * cos(A2), LINK * sin(A2))
BENT = {"parameters": (LINK, ROD, BASE), "joints": (A1, A2)}
PLANAR = load(MECHANISMS / "softkin_planar_3rrr.py")

NOWHERE = {
    "a five-bar too wide for its arms": (
        two_rods(rod("1", KNEE, P, ROD), rod("2", OTHER_KNEE, P, ROD), **BENT),
        "the loop never closes: at best rod '1' is 120 long, and should be 600, rod '2' is 120 long, and should be 600",
    ),
    "rails too far apart": (
        two_rods(
            rod("1", vector(S1, 0), P, ROD), rod("2", vector(S2, 500), P, ROD), parameters=(ROD,), joints=(S1, S2)
        ),
        "the loop never closes: at best rod '1' is 120 long, and should be 250",
    ),
    "a home pose out of reach": (
        replace(PLANAR, home=(5000, 0, 0)),
        "its home pose is not where the legs reach it: at best rod '1' is 180 long, and should be 5031",
    ),
    "a quantity that is never positive": (
        described(
            parameters=(LINK,),
            joints=(A1, RADIUS),
            chain=Rz(A1) * Tx(RADIUS),
            task=Task("xy"),
            positive=(RADIUS - LINK,),
        ),
        "-link + r must be positive, and is at most -250",
    ),
    "quantities that are never positive together": (
        described(
            parameters=(LINK, OTHER),
            joints=(A1, A2),
            chain=Rz(A1) * Tx(LINK) * Rz(A2) * Tx(OTHER),
            task=Task("xy"),
            positive=(sin(A2), -cos(A2) - 0.9, cos(A2)),
            offset_interface=False,
        ),
        "must be positive, and never are together",
    ),
    "rails that meet far from where they begin": (
        replace(
            load(MECHANISMS / "kin_tripod_linear.py"),
            parameters=tuple(
                replace(p, nominal=3000.0) if p.name == "outer_radius" else p
                for p in load(MECHANISMS / "kin_tripod_linear.py").parameters
            ),
        ),
        "no sampled pose is possible, but the loop closes at",
    ),
}


@pytest.mark.long("five-bar", "out of reach", "never positive", "rails")
@pytest.mark.parametrize("kind", NOWHERE)
def test_no_pose_closes(kind: str) -> None:
    """The sentence names what misses, and by how much; it comes within seconds."""
    mechanism, sentence = NOWHERE[kind]
    start = time.process_time()
    with pytest.raises((DescriptionError, Disagreement), match=re.escape(sentence)):
        derive_and_measure(validate(mechanism))
    assert time.process_time() - start < 10.0
