"""Tables of Denavit-Hartenberg parameters: the product of the matrices of the textbooks, both conventions and files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from tests.importing.kinematics import Array, Pose, described, differences, imported

Row = tuple[str, float, float, float, float]
"""Type, theta and d, a and alpha: degrees and millimetres."""
TABLES: Mapping[tuple[str, str], tuple[Row, ...]] = {
    ("arm with a spherical wrist", "standard"): (
        ("revolute", 0.0, 350.0, 80.0, 90.0),
        ("revolute", 90.0, 0.0, 310.0, 0.0),
        ("revolute", 0.0, 50.0, 30.0, 90.0),
        ("revolute", 0.0, 290.0, 0.0, -90.0),
        ("revolute", 0.0, 0.0, 0.0, 90.0),
        ("revolute", 180.0, 75.0, 0.0, 0.0),
    ),
    ("Stanford arm", "standard"): (
        ("revolute", 0.0, 412.0, 0.0, -90.0),
        ("revolute", 0.0, 154.0, 0.0, 90.0),
        ("prismatic", -90.0, 100.0, 0.0, 0.0),
        ("revolute", 0.0, 0.0, 0.0, -90.0),
        ("revolute", 0.0, 0.0, 0.0, 90.0),
        ("revolute", 0.0, 263.0, 0.0, 0.0),
    ),
    ("Puma", "modified"): (
        ("revolute", 0.0, 0.0, 0.0, 0.0),
        ("revolute", 0.0, 0.0, 0.0, -90.0),
        ("revolute", 0.0, 150.05, 431.8, 0.0),
        ("revolute", 0.0, 431.8, -20.32, -90.0),
        ("revolute", 0.0, 0.0, 0.0, 90.0),
        ("revolute", 0.0, 0.0, 0.0, -90.0),
        ("fixed", 30.0, 56.5, 0.0, 0.0),
    ),
    ("cylinder with a wrist", "modified"): (
        ("revolute", 20.0, 100.0, 0.0, 0.0),
        ("prismatic", 0.0, 50.0, 0.0, 0.0),
        ("prismatic", 0.0, 200.0, 0.0, -90.0),
        ("revolute", 0.0, 0.0, 0.0, 0.0),
        ("revolute", 0.0, 0.0, 0.0, -90.0),
        ("revolute", 0.0, 80.0, 0.0, 90.0),
    ),
    ("oblique axes and fixed rows", "modified"): (
        ("fixed", 10.0, 20.0, 30.0, 40.0),
        ("revolute", 5.0, 100.0, 50.0, 60.0),
        ("revolute", -33.0, -20.0, 10.0, 17.0),
        ("revolute", 12.5, 0.0, 200.0, 60.0),
        ("fixed", 1.0, 2.0, 300.0, 4.0),
    ),
    ("oblique axes and a fixed row", "standard"): (
        ("fixed", 10.0, 20.0, 30.0, 40.0),
        ("revolute", 5.0, 100.0, 50.0, 60.0),
        ("revolute", -33.0, -20.0, 0.0, 17.0),
        ("revolute", 12.5, 0.0, 200.0, 60.0),
    ),
}


def elementary(axis: int, angle: float = 0.0, shift: float = 0.0) -> Array:
    """A turn about, and a shift along, x or z."""
    c, s = np.cos(angle), np.sin(angle)
    rows = {2: [[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, shift]], 0: [[1, 0, 0, shift], [0, c, -s, 0], [0, s, c, 0]]}
    return np.array([*rows[axis], [0, 0, 0, 1]], dtype=float)


def textbook(rows: Sequence[Row], convention: str, couplings: Mapping[int, int]) -> Pose:
    """The product of a table; couplings: rows whose joint turns back with that of another row."""

    def pose(values: Mapping[str, float]) -> Array:
        total = np.eye(4)
        for k, (kind, theta, d, a, alpha) in enumerate(rows):
            value = values.get(f"A{k + 1}", 0.0)
            value -= values.get(f"A{couplings[k] + 1}", 0.0) if k in couplings else 0.0
            turned, far = np.radians(theta), d / 1000.0
            if kind == "revolute":
                turned += value
            elif kind == "prismatic":
                far += value
            about_z, about_x = elementary(2, turned, far), elementary(0, np.radians(alpha), a / 1000.0)
            total = total @ (about_z @ about_x if convention == "standard" else about_x @ about_z)
        return total

    return pose


def written(path: Path, rows: Sequence[Row], convention: str, couplings: Mapping[int, int]) -> Path:
    """The table in a file, by the ending of its name; in TOML in radians and metres."""
    if path.suffix == ".csv":
        lines = [f"# convention: {convention}", "# angles: degrees", "# lengths: mm"]
        lines.append("name; type; theta; d; a; alpha; coupling")
        for k, row in enumerate(rows):
            lines.append(";".join([f"A{k + 1}", *map(str, row), f"A{couplings[k] + 1}:-1" if k in couplings else ""]))
    else:
        lines = [f'convention = "{convention}"', 'angles = "radians"', 'lengths = "m"']
        for k, (kind, theta, d, a, alpha) in enumerate(rows):
            lines += ["[[joints]]", f'name = "A{k + 1}"', f'type = "{kind}"', f"theta = {float(np.radians(theta))!r}"]
            lines += [f"d = {d / 1000.0!r}", f"a = {a / 1000.0!r}", f"alpha = {float(np.radians(alpha))!r}"]
            lines += [f"coupling = {{A{couplings[k] + 1} = -1.0}}"] if k in couplings else []
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


@pytest.mark.parametrize("snap", [0.0, 1e-6])
@pytest.mark.parametrize("ending", [".toml", ".csv"])
@pytest.mark.parametrize("table", TABLES, ids="-".join)
@pytest.mark.parametrize("couplings", [{}, {2: 1}], ids=["", "coupled"])
def test_it_is_the_product_of_the_textbook(
    table: tuple[str, str], ending: str, snap: float, couplings: Mapping[int, int], tmp_path: Path
) -> None:
    rows, convention = TABLES[table], table[1]
    if any(row[0] == "prismatic" for row in rows):
        couplings = {5: 4} if couplings else {}
    path = written(tmp_path / f"table{ending}", rows, convention, couplings)
    found = imported(path, snap=snap)
    position, rotation = differences(found, described(found, tmp_path), textbook(rows, convention, couplings))
    assert position <= found.bounds.position + 1e-9
    assert rotation <= found.bounds.rotation + 1e-12
    assert found.moved == ()
