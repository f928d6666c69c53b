"""The directions of axes in the zero pose, in words: `about -Y`, `along Z`."""

from __future__ import annotations

import sympy as sp

from derive.description.mechanism import Mechanism
from derive.geometry.frames import Motion
from derive.geometry.pose import Screw, pose_of

_WORDS = {Motion.TURN: "about", Motion.SHIFT: "along"}


def directions_at_zero(mechanism: Mechanism) -> dict[str, str]:
    """The direction in which each joint of a chain moves in the zero pose, by its name.

    It lacks joints that move several parts of the chain, and those whose direction is none of the machine's axes.
    """
    if mechanism.chain is None:
        return {}
    at_zero = {joint.symbol: sp.Integer(0) for joint in mechanism.joints}
    found: dict[str, str] = {}
    for joint in mechanism.joints:
        screws = [s for s in pose_of(mechanism.chain).screws if joint.symbol in s.amount.free_symbols]
        if len(screws) == 1 and (axis := _axis(screws[0], joint.symbol, at_zero)) is not None:
            found[joint.name] = f"{_WORDS[screws[0].motion]} {axis}"
    return found


def _axis(screw: Screw, joint: sp.Symbol, at_zero: dict[sp.Symbol, sp.Integer]) -> str | None:
    sense = sp.sign(sp.diff(screw.amount, joint).subs(at_zero))
    direction = [sp.nsimplify(entry) for entry in screw.direction.subs(at_zero) * sense]
    places = [place for place, entry in enumerate(direction) if entry != 0]
    if len(places) != 1 or direction[places[0]] not in (1, -1):
        return None
    return ("-" if direction[places[0]] == -1 else "") + "XYZ"[places[0]]
