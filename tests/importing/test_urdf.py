"""URDF: forward kinematics of the description is that of the file, by a reader that shares nothing with ours."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.importing.kinematics import by_yourdfpy, described, differences, imported
from tests.importing.robots import COLLECTION, WRITTEN, File

EXACT = 1e-12
"""Of the size of the machine, and of one radian."""


@pytest.fixture
def file(request: pytest.FixtureRequest, tmp_path: Path) -> File:
    """A file of the collection by its name, or one that is written here: (name, digits of pi)."""
    if isinstance(request.param, str):
        return COLLECTION[request.param]
    name, digits = request.param
    path = tmp_path / f"{name.lower()}.urdf"
    path.write_text(text := WRITTEN[name](digits), encoding="utf-8")
    return File(path, "link0", f"link{text.count('<joint')}")


EVERY = pytest.mark.parametrize(
    "file", [*COLLECTION, *((name, digits) for name in WRITTEN for digits in (4, 5, 7, 9))], indirect=True, ids=str
)


def size_of(found: object) -> float:
    """The largest length of a description, as a scale."""
    return max(1.0, *(p.nominal for p in found.parameters if p.unit == "u"))  # type: ignore[attr-defined]


@EVERY
def test_unsnapped_it_is_the_file(file: File, tmp_path: Path) -> None:
    found = imported(file.path, file.base, file.tip, snap=0.0)
    mechanism = described(found, tmp_path)
    position, rotation = differences(found, mechanism, by_yourdfpy(file.path, file.base, file.tip))
    assert position <= EXACT * 1000.0 and rotation <= EXACT
    assert found.moved == () and "Nothing was snapped" in found.report


@EVERY
@pytest.mark.parametrize("snap", [1e-6, 1e-3])
def test_snapped_it_differs_by_what_is_reported(file: File, snap: float, tmp_path: Path) -> None:
    found = imported(file.path, file.base, file.tip, snap=snap)
    mechanism = described(found, tmp_path)
    position, rotation = differences(found, mechanism, by_yourdfpy(file.path, file.base, file.tip))
    assert position <= found.bounds.position + EXACT * 1000.0
    assert rotation <= found.bounds.rotation + EXACT
    assert all(moved.amount <= snap * (1.0 if moved.is_angle else 1e4) for moved in found.moved)
