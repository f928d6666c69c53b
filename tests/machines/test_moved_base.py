"""A rod whose base end a joint moves that another rod solves for: in either order of the axes, the same answers."""

import numpy as np
import pytest
import softkin
from sympy import cos, sin

from derive.description.validate import validate
from derive.mechanism import Mechanism, Task, Vendor, X, Y, assembly, branch, length, linear, rod, rotary
from derive.vectors import cross, minus, vector
from tests.machines.made import built_of, imported_class

pytestmark = pytest.mark.slow

GIVEN = {"arm_length_1": 400.0, "arm_length_2": 380.0, "crank": 100.0, "base_width": 300.0}
L1, L2, CRANK, WIDTH = (length(name, name.replace("_", " "), nominal=value) for name, value in GIVEN.items())
S, A = linear("S", "carriage along X"), rotary("A", "crank on the carriage")
ARM, TIP = vector(CRANK * cos(A), CRANK * sin(A)), vector(X, Y)
BASES = vector(S, 0), vector(S + WIDTH + ARM[0], ARM[1])
RODS = rod("1", BASES[0], TIP, L1), rod("2", BASES[1], TIP, L2)
ROWS = [minus(TIP, base) for base in BASES]
PLACES, MOST = 300, 1e-6


def _made(order: int) -> softkin.Mechanism:
    """The machine with the carriage first (1), or with the crank and its rod before the carriage (-1)."""
    mechanism = Mechanism(
        name=f"Kin_MovedBase{'First' if order == 1 else 'Last'}",
        vendor=Vendor.TEXTBOOK,
        family="parallel",
        source="the tests",
        summary="A carriage that carries a crank; a rod from each.",
        joints=(S, A)[::order],
        parameters=(L1, L2, CRANK, WIDTH),
        rods=RODS[::order],
        task=Task("xy"),
        branches=(
            branch("carriage", ROWS[0][0], left=-1, right=+1),
            branch("crank", cross(ARM, ROWS[1]), up=+1, down=-1),
        ),
        assembly=assembly("tip", cross(*ROWS), margin="rods_aligned", below=-1, above=+1),
        offset_interface=False,
    )
    return imported_class(mechanism, built_of(validate(mechanism)))(**GIVEN, tip_above=True, min_type2_margin=0.0)


@pytest.fixture(scope="module")
def both() -> tuple[softkin.Mechanism, softkin.Mechanism]:
    return _made(1), _made(-1)


def test_the_order_of_axes_changes_no_answer(both: tuple[softkin.Mechanism, softkin.Mechanism]) -> None:
    """Every answer keeps both rods rigid, and both orders have the same answers."""
    first, second = both
    rng, answered = np.random.default_rng(0), 0
    for _ in range(PLACES):
        x, y = rng.uniform(-300.0, 300.0), rng.uniform(-450.0, 450.0)
        frame = (x, y, 0.0), np.eye(3)
        own = sorted(s.axes for s in first.inverse_all(frame) if s.axes is not None)
        other = sorted(s.axes[::-1] for s in second.inverse_all(frame) if s.axes is not None)
        assert len(own) == len(other)
        assert np.allclose(own, other, rtol=0.0, atol=MOST)
        for slide, turn in own:
            answered += 1
            elbow = slide + 300.0 + 100.0 * np.cos(np.radians(turn)), 100.0 * np.sin(np.radians(turn))
            assert np.hypot(x - slide, y) == pytest.approx(400.0, abs=MOST)
            assert np.hypot(x - elbow[0], y - elbow[1]) == pytest.approx(380.0, abs=MOST)
    assert answered > 50
