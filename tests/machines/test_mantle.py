"""A mantle that is unrolled to a plane, as TRACYL does: a turn that only shifts."""

from math import pi

import pytest

from derive import compile_mechanism
from derive.frames import Tx, Ty, Tz
from derive.mechanism import Mechanism, Task, length, linear, rotary

RADIUS = length("radius", "Radius of the mantle", nominal=40.0)
X, C, Z = linear("X", "From the mantle outward"), rotary("C", "Part about its axis"), linear("Z", "Along the axis")
MANTLE = Mechanism(
    name="Mantle", parameters=(RADIUS,), joints=(X, C, Z), chain=Tx(X) * Ty(RADIUS * C) * Tz(Z), task=Task("xyz")
)


@pytest.mark.parametrize("turn", [30.0, -90.0, 1000.0])
def test_y_is_the_arc_however_far_it_is(turn: float) -> None:
    """Beyond a turn, too: the axis is no angle whose turns are chosen."""
    robot = compile_mechanism(MANTLE)(radius=40.0)
    frame, _ = robot.forward((2.0, turn, -7.0))
    assert frame.position == pytest.approx((2.0, 40.0 * turn * pi / 180.0, -7.0))
    assert robot.inverse(frame) == pytest.approx((2.0, turn, -7.0))
