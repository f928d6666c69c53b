"""All poses of a platform at its axes: those that the search of the viewer finds are all that independent ones find."""

from collections.abc import Mapping
from functools import cache
from itertools import pairwise
from json import dumps
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq, fsolve
from scipy.spatial.transform import Rotation

from tests.javascript.modules import part_of
from tests.javascript.node import run
from tests.mechanisms import named
from tests.view.pages import page_module

pytestmark = pytest.mark.slow
Array = NDArray[np.float64]
SAME = 1e-4


@cache
def module_of(name: str) -> Path:
    """The page of a machine as a module."""
    return page_module(part_of(name))


def searched(name: str, parameters: Mapping[str, float], axes: Array) -> dict[str, Any]:
    """What the page finds."""
    question = {"name": name, "parameters": dict(parameters), "axes": axes.tolist()}
    found: dict[str, Any] = run(module_of(name), f"return module.posesOf({dumps(question)})")
    return found


def nominal_of(name: str) -> dict[str, float]:
    """The nominal parameters of a machine."""
    return {parameter.name: parameter.nominal for parameter in named(name).parameters}


def points_of(given: Mapping[str, float], side: str, letters: str, count: int) -> Array:
    """The joints of the base, or of the platform."""
    return np.array([[given[f"{side}_{i}_{k}"] for k in letters] for i in range(1, count + 1)])


def are_same(found: list[Array], wanted: list[Array], within: float = SAME) -> bool:
    """Whether rows of numbers are the same, in any order."""
    apart = np.array([[np.abs(one - other).max() for other in wanted] for one in found])
    return apart.shape == (len(wanted),) * 2 and apart.min(axis=0).max() < within and apart.min(axis=1).max() < within


def hexapod(seed: int) -> dict[str, float]:
    """The joints of a hexapod in no plane; those of the nominal one for seed 0."""
    rng = np.random.default_rng(seed)
    size = 0.0 if seed == 0 else 90.0
    names = [f"{side}_{i}_{k}" for side in ("base", "platform") for i in range(1, 7) for k in "xyz"]
    nominal = nominal_of("Kin_Hexapod")
    return {name: nominal[name] + size * rng.uniform(-1.0, 1.0) for name in names}


@pytest.mark.parametrize(("seed", "count"), [(0, 12), (2, 8), (5, 12)])
def test_a_hexapod(seed: int, count: int) -> None:
    """The legs have their lengths, and SciPy finds no other pose from 900 starts."""
    given = hexapod(seed)
    base, platform = (points_of(given, side, "xyz", 6) for side in ("base", "platform"))

    def lengths(state: Array) -> Array:
        ends = state[:3] + Rotation.from_rotvec(state[3:]).apply(platform)
        return np.asarray(np.linalg.norm(ends - base, axis=1))

    axes = lengths(np.array([20.0, -30.0, 610.0, 0.1, -0.15, 0.2]))
    found = searched("Kin_Hexapod", given, axes)
    rows = [np.array([*p["frame"]["position"], *np.ravel(p["frame"]["rotation"])]) for p in found["poses"]]
    for row in rows:
        ends = row[:3] + platform @ row[3:].reshape(3, 3).T
        assert np.allclose(np.linalg.norm(ends - base, axis=1), axes, rtol=0, atol=1e-6)
    rng = np.random.default_rng(7)
    wanted: list[Array] = []
    for _ in range(900):
        start = np.array([*rng.uniform(-900.0, 900.0, 3), *rng.uniform(-np.pi, np.pi, 3)])
        state, _, status, _ = fsolve(lambda s: lengths(s) - axes, start, full_output=True)
        row = np.array([*state[:3], *Rotation.from_rotvec(state[3:]).as_matrix().ravel()])
        is_new = status == 1 and np.abs(lengths(state) - axes).max() < 1e-7
        if is_new and all(np.abs(row - other).max() > 1e-3 for other in wanted):
            wanted.append(row)
    assert len(wanted) == count and are_same(rows, wanted, 1e-3)
    assert {p["isOther"] for p in found["poses"]} == {True, False}
    assert min(p["count"] for p in found["poses"]) >= 4 and found["starts"] >= 1000


@pytest.mark.parametrize("axes", [(3.2, 137.0, -176.8), (15.8, 150.7, -174.7), (30.5, 141.3, -199.5)])
def test_a_platform_in_a_plane(axes: tuple[float, float, float]) -> None:
    """Complete: for every heading two rods leave two places, and a root of what the third misses is a pose."""
    given = nominal_of("Softkin_Planar_3RRR")
    base, platform = (points_of(given, side, "xy", 3) for side in ("base", "platform"))
    angles = np.radians(axes)
    arms, rods = ([given[f"{what}_length_{i}"] for i in (1, 2, 3)] for what in ("arm", "rod"))
    elbows = base + np.array(arms)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])

    def missed(heading: float, side: int) -> tuple[float, Array]:
        turned = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
        first, second, third = elbows - platform @ turned.T
        way = second - first
        apart = float(np.linalg.norm(way))
        along = (rods[0] ** 2 - rods[1] ** 2 + apart**2) / (2.0 * apart)
        square = rods[0] ** 2 - along**2
        place = first + (along * way + side * np.sqrt(square if square > 0 else np.nan) * way[::-1] * (-1, 1)) / apart
        return float(np.linalg.norm(place - third)) - rods[2], place

    wanted: list[Array] = []
    for side in (1, -1):
        grid = np.linspace(-np.pi, np.pi, 40001)
        values = [missed(heading, side)[0] for heading in grid]
        for (low, high), (one, other) in zip(pairwise(grid), pairwise(values), strict=True):
            if one * other < 0.0:
                heading = brentq(lambda h, s=side: missed(h, s)[0], low, high, xtol=1e-14)
                wanted.append(np.array([*missed(heading, side)[1], np.cos(heading), np.sin(heading)]))
    found = searched("Softkin_Planar_3RRR", {}, np.array(axes))
    frames = [p["frame"] for p in found["poses"]]
    rows = [np.array([*f["position"][:2], f["rotation"][0][0], f["rotation"][1][0]]) for f in frames]
    assert len(wanted) >= 2 and are_same(rows, wanted)
