"""The limits of an axis and of its drive together: against plain comparisons of numbers, and against `setup` alone."""

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from derive.description.catalogue import MECHANISMS, load
from derive.equations.windows import limits_of_axis
from derive.ir.constants import LARGEST, LIMIT
from derive.ir.interpret import run
from derive.ir.program import Status
from tests.unit.kinematics.machine import machine

PROGRAM = limits_of_axis()
NOT_A_NUMBER = math.nan
Range = tuple[float, float] | None

numbers = st.one_of(st.sampled_from([-180.0, -175.0, 0.0, 170.0, 175.0, 180.0, 540.0]), st.floats(-1e3, 1e3))
huge = st.sampled_from([math.inf, -math.inf, 1e300, -1e300, 1e9, -1e9])
ranges = st.tuples(numbers, numbers).filter(lambda r: r[0] < r[1])
drives = st.tuples(st.one_of(numbers, huge), st.one_of(numbers, huge)).filter(lambda r: r[0] <= r[1])


def both(own: Range, drive: Range) -> tuple[dict[str, float], Status]:
    """The outputs of the program. Without a range the ends of the block are zeros, and those of the drive are NaN."""
    low, high = own or (0.0, 0.0)
    lower, upper = drive or (NOT_A_NUMBER, NOT_A_NUMBER)
    values = {"own_unlimited": float(own is None), "own_lower": low, "own_upper": high}
    values |= {"drive_limited": float(drive is not None), "drive_lower": lower, "drive_upper": upper}
    found, status = run(PROGRAM, {name: np.asarray(value) for name, value in values.items()})
    return {name: float(value) for name, value in found.items()}, status.item()


@given(own=st.none() | ranges, drive=drives)
def test_it_is_what_both_allow(own: Range, drive: tuple[float, float]) -> None:
    """The range of an axis is what the limits of machine and drive both allow."""
    largest = float(LARGEST)
    low = max(drive[0], own[0] if own else -largest)
    high = min(drive[1], own[1] if own else largest)
    found, status = both(own, drive)
    assert status is (Status.OK if low <= high else Status.NOT_INITIALIZED)
    if status is Status.OK:
        tolerance = float(LIMIT) * (1.0 + abs(low) + abs(high))
        assert (found["lowest"], found["highest"]) == pytest.approx(
            (low - tolerance, high + tolerance), rel=1e-15, abs=1e-12
        )
        assert found["middle"] == pytest.approx((low + high) / 2, abs=1e-6)
        assert found["single"] == both((low, high), None)[0]["single"] or low == high


@given(limits=ranges)
def test_it_does_not_matter_who_knows_them(limits: Range) -> None:
    """The same limits in the block, in the drive, or in both."""
    assert both(limits, None) == both(None, limits) == both(limits, limits)


@pytest.mark.long
@given(lower=numbers, upper=numbers, own=st.none() | ranges)
def test_no_range_is_refused(lower: float, upper: float, own: Range) -> None:
    """Limits of a drive that are reversed, or no numbers, are refused."""
    assume(lower > upper)
    for drive in ((lower, upper), (NOT_A_NUMBER, upper), (lower, NOT_A_NUMBER), (math.inf, -math.inf)):
        assert both(own, drive)[1] is Status.BAD_INPUT


@pytest.mark.parametrize(
    "limits", [None, (-170.0, 170.0), (-175.0, 175.0), (-175.5, 175.5), (-180.0, 180.0), (-400.0, 20.0)]
)
def test_a_drive_that_is_not_known_changes_nothing(limits: Range) -> None:
    """Then it is what `setup` computes by itself."""
    lower, upper = limits or (0.0, 0.0)
    alone = machine(load(MECHANISMS / "kin_scara2_z.py"), lower_a1=lower, upper_a1=upper).constants
    found, status = both(limits, None)
    assert status is Status.OK
    assert (found["lowest"], found["highest"]) == (alone["lowest_a1"].item(), alone["highest_a1"].item())
    assert found["single"] == alone["single_a1"].item()
    assert limits is None or found["middle"] == alone["mid_a1"].item()
