"""The setup computes each value of the parameters once."""

from collections import Counter

import pytest

from derive.description.catalogue import MECHANISMS, load
from derive.kinematics.build import build


@pytest.mark.long
@pytest.mark.parametrize("file", ["kin_scara3_ccz.py", "kin_p2x_type1.py"])
def test_no_two_constants_have_the_same_value(file: str) -> None:
    """What the programs need, and the setup has already, is read by the name that it has."""
    setup = build(load(MECHANISMS / file)).setup
    values = Counter(let.value for let in setup.lets() if let.value.args)
    assert len(values) > 3 and not [value for value, times in values.items() if times > 1]
