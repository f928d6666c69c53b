"""A generated block costs little more than one that is written by hand: `bench/` holds such blocks of four kinds."""

import pytest

from bench.blocks import FOLDER, KINDS, Kind, measured

RATIO = 1.3
"""The algebra to that by hand, at most."""
CALLS = 30
"""Calls of functions a solution, at most."""
ROUNDING = 1e-13


@pytest.mark.parametrize("kind", KINDS, ids=lambda k: k.name)
def test_the_text_by_hand_is_right(kind: Kind) -> None:
    """Forward kinematics, which the closure has proven, leads from its answers back to the pose, on its branch."""
    found = measured(kind)
    assert found.poses >= 40
    assert found.missed < ROUNDING


@pytest.mark.parametrize("kind", KINDS, ids=lambda k: k.name)
def test_a_call_costs_no_more_than_promised(kind: Kind) -> None:
    """The whole call, all calls of functions, and the algebra beside that by hand."""
    found = measured(kind)
    assert found.call <= kind.most
    assert found.calls <= CALLS
    assert found.ratio <= RATIO
    assert min(found.by_hand) > 30, "something was counted"


def test_every_text_by_hand_is_measured() -> None:
    """No text stands in the folder without being run."""
    assert {path.stem for path in FOLDER.glob("*.st")} == {kind.by_hand for kind in KINDS}
