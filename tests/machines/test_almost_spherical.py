"""A small arm whose wrist axes miss each other by a millimetre: roots stand in close pairs, and the search is long."""

import pytest

from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.mechanism import Task, Turning, length, rotary
from derive.pipeline import derive_and_measure
from tests.machines.textbook import textbook

AXES = tuple(rotary(f"A{k}", f"turn A{k}") for k in range(1, 7))
A1, A2, A3, A4, A5, A6 = AXES
UPPER, FORE = length("link_a", "upper arm", nominal=100.0), length("link_b", "forearm", nominal=108.0)
BESIDE, ABOVE = length("beside", "elbow to A4, sideways", nominal=1.0), length("above", "elbow to A4", nominal=5.0)
WRIST, FLANGE = length("wrist", "A5 to A6", nominal=1.0), length("link_c", "wrist to flange", nominal=60.0)


@pytest.mark.slow
def test_it_is_measured_within_the_bound_of_work() -> None:
    wrist = Rx(A4) * Tx(FORE) * Ry(A5) * Ty(WRIST) * Rx(A6) * Tx(FLANGE)
    chain = Rz(A1) * Ry(A2) * Tz(UPPER) * Ry(A3) * Ty(-BESIDE) * Tz(ABOVE) * wrist
    stock = (*AXES, UPPER, FORE, BESIDE, ABOVE, WRIST, FLANGE)
    kin = derive_and_measure(textbook(stock, "AlmostSpherical", chain, Task("xyz", Turning.FULL)))
    assert kin.self_test is not None and kin.evidence is not None
    assert kin.evidence.inverted is not None and kin.evidence.inverted.missed is not None
    assert kin.evidence.inverted.missed[0] == 0
