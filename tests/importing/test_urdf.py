"""URDF: forward kinematics of the description is that of the file, by a reader that shares nothing with ours."""

import re
from pathlib import Path

import pytest

from tests.importing.kinematics import UNSNAPPED, assert_is, by_yourdfpy, imported
from tests.importing.robots import COLLECTION, WRITTEN, File, written

pytestmark = pytest.mark.slow

EXACT = 1e-12
"""Of the size of the machine, and of one radian."""


ROUNDED = 5e-4
"""What rounding to three decimals makes of an angle."""
DIGITS = range(4, 10)


@pytest.fixture
def file(request: pytest.FixtureRequest, tmp_path: Path) -> File:
    """A file of the collection by its name, or one that is written here: (name, digits of pi)."""
    if isinstance(request.param, str):
        return COLLECTION[request.param]
    return written(*request.param, tmp_path)


EVERY = pytest.mark.parametrize(
    "file", [*COLLECTION, *((name, digits) for name in WRITTEN for digits in DIGITS)], indirect=True, ids=str
)


@EVERY
def test_unsnapped_it_is_the_file(file: File, tmp_path: Path) -> None:
    found = imported(file.path, file.base, file.tip, snap=0.0)
    assert_is(found, tmp_path, by_yourdfpy(file.path, file.base, file.tip), EXACT * 1000.0, EXACT)
    assert found.bounds.rotation <= UNSNAPPED
    assert all("differences below 1e-9" in one.what for one in found.moved)


@EVERY
@pytest.mark.parametrize("snap", [1e-6, 1e-3])
def test_snapped_it_differs_by_what_is_reported(file: File, snap: float, tmp_path: Path) -> None:
    found = imported(file.path, file.base, file.tip, snap=snap)
    assert_is(found, tmp_path, by_yourdfpy(file.path, file.base, file.tip), EXACT * 1000.0, EXACT)
    assert all(moved.amount <= (max(snap, ROUNDED) if moved.is_angle else snap * 1e4) for moved in found.moved)


@pytest.mark.parametrize("name", WRITTEN)
def test_pi_rounded_to_any_digits_is_pi(name: str, tmp_path: Path) -> None:
    """The description is that of the unrounded file, to the letter: what derives with pi derives with 3.142."""
    exact = imported(written(name, 17, tmp_path).path)
    assert all(moved.amount < 1e-14 for moved in exact.moved) and "radians(" not in exact.text
    for digits in DIGITS:
        found = imported(written(name, digits, tmp_path).path)
        assert found.text == exact.text
        angles = [moved.amount for moved in found.moved]
        assert angles and max(angles) <= 10.0 ** (1 - digits) and all(moved.is_angle for moved in found.moved)
        assert found.bounds.rotation <= 2.0 * sum(angles) * (1.0 + 1e-9)


@pytest.mark.parametrize("name", WRITTEN)
def test_with_three_digits_it_is_an_angle_of_its_own(name: str, tmp_path: Path) -> None:
    """3.14 may be meant: the report says which `--snap` would make it pi, and with that it is."""
    file = written(name, 3, tmp_path)
    report = imported(file.path).report
    snap = re.search(r"may be rounded multiples of 15°: \d+\. --snap (\S+) reads", report)
    assert snap is not None
    assert imported(file.path, snap=float(snap[1])).text == imported(written(name, 17, tmp_path).path).text
