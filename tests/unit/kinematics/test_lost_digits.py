"""Refusals behind lost digits."""

from dataclasses import replace

import pytest
import sympy as sp

from derive.ir.interpret import evaluate
from derive.ir.program import Require, Status
from derive.ir.reason import Unit, Why, about_joint
from derive.ir.symbols import real
from derive.kinematics.lost_digits.doubts import _joined

MISSING, DIFFERENCE, ELBOW = map(real, ("missing", "difference", "elbow"))


@pytest.mark.parametrize(("missing", "told"), [(3.0, 3.0), (-2.0, 0.0)])
def test_no_amount_is_negative(missing: float, told: float) -> None:
    """A machine within reach whose digits are lost misses nothing; one beyond it what it missed before."""
    why = replace(about_joint(ELBOW, Why.OUT_OF_REACH), amount=MISSING, unit=Unit.LENGTH)
    reach = Require(sp.Le(MISSING, 0), Status.UNREACHABLE, reason=why)
    alike = Require(sp.Le(DIFFERENCE, 1), Status.UNREACHABLE, reason=about_joint(ELBOW, Why.OUT_OF_REACH))
    (one,) = _joined([alike], [reach])
    assert one.reason is not None and one.reason.amount is not None
    assert evaluate(one.reason.amount, {"missing": missing}) == told
    assert _joined([], [reach]) == [reach]
