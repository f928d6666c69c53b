"""The home pose of a platform may be stated by a length, whose sign the solver knows."""

import pytest
import sympy as sp

from derive.description.mechanism import length
from derive.form.inner_names import with_symbols
from derive.kinematics.build import build
from tests.mechanisms import named


@pytest.mark.long
def test_a_home_pose_may_be_a_length() -> None:
    described = named("Kin_Hexapod")
    read = {s for v in described.home for s in sp.sympify(v).free_symbols}
    own = next(p for p in described.parameters if p.symbol in read)
    height = length(own.name, own.meaning, nominal=abs(own.nominal) or 100.0)
    stated = with_symbols(described, {own.symbol: height.symbol})
    assert own.symbol != height.symbol and stated.home != described.home
    assert build(stated).forward.outputs
