"""Tables of Denavit-Hartenberg parameters: the product of the matrices of the textbooks, both conventions and files."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from tests.importing.kinematics import Array, Pose, assert_is, chain_pose, described, imported, imported_text, refused

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
    assert_is(found, tmp_path, textbook(rows, convention, couplings))
    assert found.moved == ()


STRANGE = {
    "semicolons and capital letters": (
        "r.CSV",
        "\ufeff# Convention: Standard\n# Angles: Degrees\n# Lengths: mm\n\n Name ; A ; Alpha ; D ; Type\n"
        "J1;0;9e1;4e2;Revolute\n# the arm\nJ2;300;0;;REVOLUTE\nJ3;+250.0;;;\n",
    ),
    "cells of a spreadsheet": (
        "r.csv",
        '"# convention: standard"\n"# angles: degrees"\n"# lengths: mm"\n"name","a","alpha","d"\n'
        '"J1","0","90","400"\n"J2","300","",""\n"J3","250","",""\n',
    ),
    "tabs, and cells that are empty": (
        "r.csv",
        "# convention: standard\n# angles: radians\n# lengths: m\nname\ta\td\talpha\n"
        "J1\t0\t.4\tpi/2\nJ2\t.3\t\t\nJ3\t25e-2\t\t\n",
    ),
    "a table with pi and numbers in groups": (
        "r.toml",
        'Convention = "STANDARD" # as in the book\nangles = "radians"\nlengths = "m"\n'
        '[[joints]]\nname = "J1"\nd = 0.4_00\nalpha = " 1*pi / 2"\n[[joints]]\nname = "J2"\na = 3.0e-1\n'
        '[[joints]]\nname = "J3"\na = 0.25\n',
    ),
    "pi with four decimals": (
        "r.toml",
        'convention = "standard"\nangles = "radians"\nlengths = "mm"\n[[joints]]\nname = "J1"\nd = 400\n'
        'Alpha = 1.5708\n[[joints]]\nName = "J2"\na = 300\n[[joints]]\nname = "J3"\na = 250\n',
    ),
}


@pytest.mark.parametrize("name", STRANGE)
def test_a_table_of_an_odd_look_is_the_same_arm(name: str, tmp_path: Path) -> None:
    """All of them write an elbow arm: 400 up, links of 300 and 250."""
    file, text = STRANGE[name]
    found = imported_text(tmp_path / file, text)
    assert found.axes == ("J1", "J2", "J3") and "radians(" not in found.text
    mechanism = described(found, tmp_path)
    for q1, q2, q3 in np.random.default_rng(2).uniform(-3.0, 3.0, (8, 3)):
        pose = chain_pose(mechanism, {"J1": q1, "J2": q2, "J3": q3})
        out = 300.0 * np.cos(q2) + 250.0 * np.cos(q2 + q3)
        up = 400.0 + 300.0 * np.sin(q2) + 250.0 * np.sin(q2 + q3)
        assert np.allclose(pose[:3, 3], [np.cos(q1) * out, np.sin(q1) * out, up], rtol=0.0, atol=1e-9)
        assert np.allclose(pose[:3, 2], [np.sin(q1), -np.cos(q1), 0.0], rtol=0.0, atol=1e-12)


def test_pi_is_no_angle_in_degrees(tmp_path: Path) -> None:
    text = 'convention = "standard"\nangles = "degrees"\nlengths = "mm"\n[[joints]]\nalpha = "pi/2"\n'
    assert "row 'A1', alpha: 'pi/2' is no number" in refused(tmp_path / "r.toml", text)
