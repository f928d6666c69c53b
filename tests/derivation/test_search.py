"""The search along a joint, on residuals whose roots are known."""

from __future__ import annotations

import numpy as np
import pytest
import sympy as sp

from derive.passes import assemble
from derive.program import Let, Output, Status, real
from derive.run import run
from derive.search import TRIED, Trial, search_loop

START = real("start")


def roots(
    residual: sp.Expr, start: float, crossing: float, fits: sp.Basic = sp.true, rank: int | None = None
) -> tuple[float, Status]:
    """Where the search from `start` ends."""
    value = real("residual")
    trial = Trial((Let(value, residual),), value, fits)
    loop = search_loop(trial, START, real("crossing"), sp.false, is_ranked=rank is not None)
    program = assemble("search", (loop,), [Output("found", TRIED), Output("accepted", real("accepted"))])
    inputs = {"start": start, "crossing": crossing} | ({} if rank is None else {"rank": rank})
    outputs, status = run(program, {name: np.asarray(float(value)) for name, value in inputs.items()})
    accepted = float(outputs["accepted"]) > 0.5
    return float(outputs["found"]), Status(status.item()) if accepted else Status.UNREACHABLE


@pytest.mark.parametrize("start", np.linspace(-3.0, 3.0, 9))
@pytest.mark.parametrize("crossing", (1.0, -1.0))
def test_the_nearest_root_of_the_wanted_slope(start: float, crossing: float) -> None:
    found, status = roots(sp.sin(3 * TRIED) / 2, start, crossing)
    assert status is Status.OK
    # sin 3t vanishes at k pi / 3; it rises for even k
    candidates = [k * np.pi / 3 for k in range(-12, 13) if (k % 2 == 0) == (crossing > 0)]
    assert min(abs(c - found) for c in candidates) < 1e-13
    assert abs(found - start) == pytest.approx(min(abs(c - start) for c in candidates), abs=1e-13)


@pytest.mark.parametrize("start", (-2.0, 0.1, 1.5))
def test_roots_are_ranked_by_how_far_they_are(start: float) -> None:
    candidates = sorted((k * 2 * np.pi / 3 for k in range(-12, 13)), key=lambda c: abs(c - start))
    for rank in range(3):
        found, status = roots(sp.sin(3 * TRIED) / 2, start, 1.0, rank=rank)
        assert status is Status.OK
        assert found == pytest.approx(candidates[rank], abs=1e-13)
    assert roots(sp.sin(3 * TRIED) / 2, start, 1.0, rank=4)[1] is Status.UNREACHABLE


def test_a_touched_root_may_be_met_again_beside_its_flat_place_and_then_no_more() -> None:
    residual = (1 - sp.cos(TRIED)) / 2
    assert roots(residual, 0.0, 1.0, rank=0) == (0.0, Status.OK)
    again, status = roots(residual, 0.0, 1.0, rank=1)
    assert status is Status.OK
    assert abs(again) < np.radians(1e-4)
    assert roots(residual, 0.0, 1.0, rank=2)[1] is Status.UNREACHABLE


def test_behind_a_touched_root_of_another_branch_the_search_goes_on() -> None:
    """(1 - cos t) sin(t - 2) touches zero at 0, where the trial does not fit, and crosses it at 2."""
    found, status = roots((1 - sp.cos(TRIED)) * sp.sin(TRIED - 2) / 2, 0.0, 1.0, sp.Gt(sp.sin(TRIED), sp.Rational(1, 2)))
    assert status is Status.OK
    assert found == pytest.approx(2.0, abs=1e-12)


def test_a_root_at_the_start() -> None:
    for crossing, expected in ((1.0, Status.OK), (-1.0, Status.OK)):
        found, status = roots(sp.sin(TRIED), 0.0 if crossing > 0 else np.pi, crossing)
        assert status is expected
        assert np.sin(found) == pytest.approx(0.0, abs=1e-14)


def test_a_root_of_the_other_slope_at_the_start_is_not_taken() -> None:
    found, status = roots(sp.sin(TRIED), 0.0, -1.0)
    assert status is Status.OK
    assert abs(found) == pytest.approx(np.pi, abs=1e-12)


@pytest.mark.parametrize("crossing", (1.0, -1.0))
def test_a_root_that_is_touched_at_the_start(crossing: float) -> None:
    found, status = roots((1 - sp.cos(TRIED)) / 2, 0.0, crossing)
    assert (found, status) == (0.0, Status.OK)


@pytest.mark.parametrize("crossing", (1.0, -1.0))
def test_a_jump_is_no_root(crossing: float) -> None:
    """cos t over its size: jumps at ±90 degrees and never vanishes."""
    assert roots(sp.cos(TRIED) / sp.Abs(sp.cos(TRIED)), 0.3, crossing)[1] is Status.UNREACHABLE


def test_no_root() -> None:
    assert roots(2 + sp.sin(TRIED), 0.0, 1.0)[1] is Status.UNREACHABLE


def test_a_root_of_another_branch_is_passed_over() -> None:
    found, status = roots(sp.sin(2 * TRIED), 0.1, 1.0, sp.Lt(sp.cos(TRIED), 0))
    assert status is Status.OK
    assert found == pytest.approx(np.pi, abs=1e-13)


def test_not_a_number_ends() -> None:
    assert roots(sp.sin(TRIED), np.nan, 1.0)[1] is Status.UNREACHABLE
