"""Every test of this folder that asks for a machine runs for each of them."""

from __future__ import annotations

import pytest

from tests.catalogue.hexapod.machines import NAMES, Machine, machines


@pytest.fixture(params=NAMES)
def machine(request: pytest.FixtureRequest) -> Machine:
    """A hexapod by its label."""
    return machines()[request.param]
