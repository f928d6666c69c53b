"""Closed loops that only turn their platform, about a point that stays where it is."""

from collections.abc import Mapping

import sympy as sp
from sympy import cos, pi, sin

from derive.mechanism import ROTATION, Joint, Mechanism, Rod, Task, Turning, guide, length, linear, rod, rotary

S1, S2, S3 = (linear(f"S{k}", f"length of pushrod {k}", nominal=230.0) for k in (1, 2, 3))
A1, A2, A3 = (rotary(f"A{k}", f"turn {k}") for k in (1, 2, 3))
RADIUS = length("radius", "distance of the joints from the centre", nominal=100.0)
DEPTH = length("depth", "depth of the base below the centre", nominal=0.2)
METRES = length("radius", "distance of the joints from the centre, in metres", nominal=0.1)


def _on_ball(x: object, y: object, z: object = 0) -> tuple[sp.Expr, ...]:
    return tuple(ROTATION * sp.Matrix([x, y, z]))


def _pushrod(number: int, joint: Joint) -> Rod:
    turn = 2 * pi * number / 3
    base = RADIUS * cos(turn + 1), RADIUS * sin(turn + 1), -2 * RADIUS
    return rod(str(number + 1), base, _on_ball(RADIUS * cos(turn), RADIUS * sin(turn)), joint)


ACROSS = (sp.Matrix([0, -sin(A1), cos(A1)]), sp.Matrix([cos(A2), 0, -sin(A2)]), sp.Matrix([-sin(A3), cos(A3), 0]))
CARRIED = (sp.Matrix([0, 1, 0]), sp.Matrix([0, 0, 1]), sp.Matrix([1, 0, 0]))

CRANK = length("crank", "length of a crank", nominal=50.0)
RODS = tuple(length(f"rod_{k}", f"length of rod {k}", nominal=size) for k, size in ((1, 200.0), (2, 130.0)))


def _crank(number: int, joint: Joint, low: float, aside: int) -> Rod:
    """A crank about Y, zero backwards and positive upwards, and its rod: one motor stands above the other."""
    knee = -10 - CRANK * cos(joint), aside * 45, CRANK * sin(joint) - low
    return rod(str(number), knee, _on_ball(-60, aside * 45), RODS[number - 1])


SPHERICAL: Mapping[str, Mechanism] = {
    "ball on three pushrods": Mechanism(
        name="Kin_BallOnPushrods",
        joints=(S1, S2, S3),
        parameters=(RADIUS,),
        rods=tuple(_pushrod(k, s) for k, s in enumerate((S1, S2, S3))),
        task=Task("", Turning.FULL),
        positive=(S1, S2, S3),
        home=(0, 0, 0),
    ),
    "camera on three curved arms": Mechanism(
        name="Kin_CurvedArms",
        joints=(A1, A2, A3),
        closure=tuple((w.T * ROTATION * v)[0] for w, v in zip(ACROSS, CARRIED, strict=True)),
        task=Task("", Turning.FULL),
        home=(0, 0, 0),
    ),
    "mirror on a cardan joint, in metres": Mechanism(
        name="Kin_CardanMirror",
        joints=(S1, S2),
        parameters=(METRES, DEPTH),
        rods=(
            rod("1", (METRES, 0, -DEPTH), _on_ball(METRES, 0), S1),
            rod("2", (0, METRES, -DEPTH), _on_ball(0, METRES), S2),
        ),
        guides=(guide("cardan", (1, 0, 0), _on_ball(0, METRES)),),
        task=Task("", Turning.DIRECTION),
        positive=(S1, S2),
        home=(0, 0, 0),
    ),
    "ankle on a cardan joint with two cranks": Mechanism(
        name="Kin_Ankle",
        joints=(A1, A2),
        parameters=(CRANK, *RODS),
        rods=(_crank(1, A1, 200, 1), _crank(2, A2, 130, -1)),
        guides=(guide("cardan", (0, 1, 0), _on_ball(CRANK, 0)),),
        task=Task("", Turning.DIRECTION),
        home=(0, 0, 0),
    ),
}
