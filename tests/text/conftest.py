"""Every test that asks for a mechanism or its twins runs for the whole catalogue."""

from __future__ import annotations

import pytest

from derive.description.mechanism import Mechanism
from tests.text.twins import MECHANISMS, Twins, twins_of


@pytest.fixture(params=MECHANISMS, ids=lambda m: m.name)
def mechanism(request: pytest.FixtureRequest) -> Mechanism:
    """A mechanism of the catalogue."""
    return request.param


@pytest.fixture
def twins(mechanism: Mechanism) -> tuple[Twins, ...]:
    """Its machines, each as a block and in Python."""
    return twins_of(mechanism)
