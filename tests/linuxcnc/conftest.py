"""The folders of modules go when the tests are over."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.linuxcnc import module


@pytest.fixture(scope="session", autouse=True)
def _folders() -> Iterator[None]:
    yield
    module.remove()
