"""Every test that asks for a mechanism or its loops runs for every mechanism with rods."""

from __future__ import annotations

import pytest

from derive.description.mechanism import Mechanism
from tests.text.loops.machines import LOOPS, Loop, loops_of


@pytest.fixture(params=LOOPS, ids=lambda m: m.name)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    """A mechanism with rods."""
    return request.param


@pytest.fixture
def loops(mechanism: Mechanism) -> tuple[Loop, ...]:
    """Its machines, each as a block and in Python."""
    return loops_of(mechanism)
