"""Poses next to where the branches of a search meet, of an arm on a turntable that is held."""

import pytest

from derive.description.mechanism import Mechanism, Task, Turning, rotary
from derive.description.validate import validate
from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.kinematics.build import build
from derive.witness import witness

E1, A1, A2, A3, A4, A5, A6 = (rotary(name, f"turn {name}") for name in ("E1", "A1", "A2", "A3", "A4", "A5", "A6"))
ARM = Rz(A1) * Ry(A2) * Tz(540) * Ry(A3) * Tx(540) * Rx(A4) * Ty(150) * Ry(A5) * Rx(A6) * Tx(160)


@pytest.mark.slow
def test_a_held_turn_keeps_its_value_at_a_planted_pose() -> None:
    """The other references are far away; that of a held joint is where the pose was planted."""
    table = Mechanism(
        name="OnTurntable",
        joints=(E1, A1, A2, A3, A4, A5, A6),
        chain=Ry(E1) * Tx(100) * ARM,
        task=Task("xyz", Turning.FULL),
        held=(E1,),
    )
    evidence = witness(build(validate(table)), table)
    assert evidence.inverted is not None and evidence.inverted.missed is not None
    missed, asked = evidence.inverted.missed
    assert asked > 100 and missed <= 0.01 * asked
