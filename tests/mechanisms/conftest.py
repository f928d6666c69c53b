"""Every test that asks for a mechanism or its machines runs for the whole catalogue."""

from __future__ import annotations

import pytest

from derive.mechanism import Mechanism
from tests.mechanisms.machines import MECHANISMS, Machine, machines_of


@pytest.fixture(params=MECHANISMS, ids=lambda m: m.name)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    """A mechanism of the catalogue."""
    return request.param


@pytest.fixture
def machines(mechanism: Mechanism) -> tuple[Machine, ...]:
    """Its machines."""
    return machines_of(mechanism)
