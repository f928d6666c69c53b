"""All poses of a platform at its axes: those that the search of the viewer finds are all that independent ones find."""

from collections.abc import Mapping
from functools import cache
from json import dumps
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.catalogue.platform_poses import (
    Array,
    are_same,
    beside_home,
    every_pose,
    hexapod,
    missed,
    nominal_of,
    poses_in_a_plane,
)
from tests.javascript.modules import part_of
from tests.javascript.node import run
from tests.view.pages import page_module

pytestmark = pytest.mark.slow


@cache
def module_of(name: str) -> Path:
    """The page of a machine as a module."""
    return page_module(part_of(name))


def searched(name: str, parameters: Mapping[str, float], axes: Array) -> dict[str, Any]:
    """What the page finds."""
    question = {"name": name, "parameters": dict(parameters), "axes": axes.tolist()}
    found: dict[str, Any] = run(module_of(name), f"return module.posesOf({dumps(question)})")
    return found


@pytest.mark.parametrize(("seed", "count"), [(0, 12), (2, 8), (5, 12)])
def test_a_hexapod(seed: int, count: int) -> None:
    """The legs have their lengths, and random starts find no other pose."""
    machine = hexapod(seed)
    axes = beside_home(machine)
    found = searched("Kin_Hexapod", machine.given, axes)
    rows = np.array([[*p["frame"]["position"], *np.ravel(p["frame"]["rotation"])] for p in found["poses"]])
    assert missed(machine, axes, rows) < 1e-6
    assert len(rows) == count and are_same(rows, every_pose(machine, axes), 1e-3)
    assert {p["isOther"] for p in found["poses"]} == {True, False}
    assert min(p["count"] for p in found["poses"]) >= 4 and found["starts"] >= 1000


@pytest.mark.parametrize("axes", [(3.2, 137.0, -176.8), (15.8, 150.7, -174.7), (30.5, 141.3, -199.5)])
def test_a_platform_in_a_plane(axes: tuple[float, float, float]) -> None:
    """Complete: for every heading two rods leave two places, and a root of what the third misses is a pose."""
    wanted = poses_in_a_plane(nominal_of("Softkin_Planar_3RRR"), np.array(axes))
    frames = [p["frame"] for p in searched("Softkin_Planar_3RRR", {}, np.array(axes))["poses"]]
    rows = np.array([[*f["position"][:2], f["rotation"][0][0], f["rotation"][1][0]] for f in frames])
    assert len(wanted) >= 2 and are_same(rows, wanted, 1e-4)
