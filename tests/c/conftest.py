"""The folders of programs go when the tests are over."""

from collections.abc import Iterator

import pytest

from tests.c import programs


@pytest.fixture(scope="session", autouse=True)
def _folders() -> Iterator[None]:
    yield
    programs.remove()
