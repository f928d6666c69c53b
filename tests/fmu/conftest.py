"""The folders of FMUs go when the tests are over."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.fmu import simulated


@pytest.fixture(scope="session", autouse=True)
def _folders() -> Iterator[None]:
    yield
    simulated.remove()
