"""The blocks that set and read configurations of closed loops: the tests of the serial machines."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.text import test_configuration_blocks as serial
from tests.text.loops.machines import Loop

TESTS = (
    serial.test_what_is_set_is_read,
    serial.test_without_inputs_it_is_the_default,
    serial.test_a_turn_that_a_byte_cannot_hold_is_automatic,
    serial.test_every_byte_can_be_read,
    serial.test_what_is_set_drives_inverse_kinematics,
    serial.test_a_branch_byte_that_means_nothing_is_refused,
    serial.test_connectible_is_an_equivalence_of_branch_bytes,
)


@pytest.mark.parametrize("test", TESTS, ids=lambda test: test.__name__)
def test_blocks(loops: tuple[Loop, ...], test: Callable[[Loop], None]) -> None:
    """A loop with one solution has no configuration, and no such blocks."""
    if loops[0].robot.CONFIGURATION:
        test(loops[1])
    else:
        assert f"{loops[0].mechanism.block_name}_Config" not in loops[0].library.objects
