"""Fixed half turns stand at the end of a chain that turns about z alone: the chain reaches the same frames."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derive.geometry.frames import Chain, Motion, Rx, Ry, Rz, Tx, Ty, Tz, flip_x
from derive.geometry.half_turns import with_half_turns_last

A, B = sp.symbols("a b", real=True)
FLAG = sp.Symbol("flag", integer=True)
VALUES = {A: 0.7, B: -1.9, FLAG: 1}

PARTS = (Rz(A), Tz(2), Tx(3), Ty(5), Rz(-B), Rx(sp.pi), Ry(sp.pi), Ry(-3 * sp.pi), Rz(sp.pi), Rz(sp.pi / 4))


def _frame(chain: Chain) -> np.ndarray:
    return np.array(chain.matrix().xreplace(VALUES).evalf(20), dtype=float)


def _product(parts: list[Chain]) -> Chain:
    whole = Chain(())
    for part in parts:
        whole = whole * part
    return whole


@given(parts=st.lists(st.sampled_from(PARTS), min_size=1, max_size=9), flipped=st.booleans())
def test_the_same_frame(parts: list[Chain], flipped: bool) -> None:
    """The frame at the end is the same to rounding, and no turn about x or y is left among the joints."""
    chain = _product([*parts, flip_x(FLAG)] if flipped else parts)
    moved = with_half_turns_last(chain)
    assert np.abs(_frame(moved) - _frame(chain)).max() <= 1e-14 * 100
    assert all(f.axis == 2 for f in moved.factors if f.motion is Motion.TURN)
    motions = [f.motion for f in moved.factors]
    assert Motion.FLIP not in motions or set(motions[motions.index(Motion.FLIP) :]) == {Motion.FLIP}


@pytest.mark.parametrize(
    "chain",
    [Rz(A) * Tx(1), Rx(A) * Rx(sp.pi), Rx(sp.pi) * Ry(B), Rx(sp.pi / 2) * Rz(A), Rx(2 * sp.pi) * Rz(A)],
    ids=str,
)
def test_other_chains_stay(chain: Chain) -> None:
    """A chain without half turns, or with other turns than those about z, is left alone."""
    assert with_half_turns_last(chain) == chain


def test_two_half_turns_cancel() -> None:
    """Two half turns about one axis leave nothing behind."""
    assert with_half_turns_last(Rx(sp.pi) * Rz(A) * Ty(5) * Rx(sp.pi)) == Rz(-A) * Ty(-5)
