"""The scan finds every solution that algebra finds, at random poses and where roots are close."""

from collections.abc import Iterator
from functools import cache
from itertools import product

import numpy as np
import pytest

from derive.equations.axes import reference_value
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.program import Output, Program
from derive.kinematics.parameters import machine_scale
from derive.kinematics.scan.derivations import Scanned, solve_both, wanted
from derive.kinematics.scan.programs import LOOKED_FOR, START
from derive.mechanisms import kin_ac6_rzryryrxryrz_j6offset as arm
from tests.algebra.search import AWAY, ONWARD, search_of
from tests.algebra.wave import wave_program
from tests.catalogue.search.arms import Array
from tests.catalogue.search.planted import ARM, Planted, planted

MOST = 48
"""More solutions of one choice of sides than there can be."""


@cache
def machine() -> tuple[Scanned, Program]:
    both = solve_both(arm.MECHANISM)
    return both, search_of(both)


def test_the_residuals_of_all_branches_are_a_wave_of_degree_eight() -> None:
    assert wave_program(machine()[0])[1] == 8


def test_both_find_the_same_solutions() -> None:
    check_both_find_the_same("anywhere", 60.0, 6)


@pytest.mark.sweep
@pytest.mark.parametrize(("kind", "lateral"), [("anywhere", -300.0), ("straight wrist", 8.0), ("anywhere", 1e-3)])
def test_both_find_the_same_of_many(kind: str, lateral: float) -> None:
    check_both_find_the_same(kind, lateral, 24)


def check_both_find_the_same(kind: str, lateral: float, count: int) -> None:
    """Every solution of the scan, and the planted one, is one of algebra, and the other way round."""
    case = planted(kind, lateral, count, 91)
    found: list[list[Array]] = [[] for _ in case.axes]
    for shoulder, elbow in product((1, -1), repeat=2):
        for row, axes in every_root(case, {"shoulder": shoulder, "elbow": elbow}):
            found[row].append(axes)
    for axes, roots in zip(case.axes, found, strict=True):
        every = case.robot.inverse_all(case.robot.forward(tuple(axes))[0])
        known = np.array([a for s in every if s.axes is not None for a in (s.axes, *s.others)])
        for root in (axes, *roots):
            assert np.abs((known - root + 180.0) % 360.0 - 180.0).max(axis=1).min() < 1e-5
        for one in known:
            assert np.abs((np.array(roots) - one + 180.0) % 360.0 - 180.0).max(axis=1).min() < 1e-5


def every_root(case: Planted, signs: dict[str, int]) -> Iterator[tuple[int, Array]]:
    """The rows, and the axes of every root with these signs: the next one ahead, again and again around the circle."""
    both, find = machine()
    positions, rotations, _, _ = case.robot.forward_batch(case.axes)
    given = {k: np.asarray(v) for k, v in {**ARM, "j6_offset_x": case.lateral}.items()}
    scale = normalise("scale", [], [Output("scale", machine_scale(both.mechanism))])
    given["machine_scale"] = run(scale, given)[0]["scale"] * 1.0
    given |= {f"goal_{c}": positions[:, k] for k, c in enumerate("xyz")}
    given |= {f"goal_r{i + 1}{j + 1}": rotations[:, i, j] for i, j in product(range(3), repeat=2)}
    given |= {wanted(b).name: np.asarray(signs.get(b.name, 0)) for b in both.mechanism.branches}
    given |= {reference_value(j).name: np.asarray(0.0) for j in both.mechanism.joints}
    count = len(case.axes)
    at, left, going = np.full(count, 2.5), np.full(count, np.inf), np.ones(count, dtype=bool)
    for _ in range(MOST):
        given |= {START.name: at, LOOKED_FOR.name: going, ONWARD.name: np.ones(count, dtype=bool)}
        said, _ = run(find, given)
        left = np.where(np.isinf(left), 2.0 * np.pi, left - said[AWAY.name])
        going = going & said["found"] & (left > 1e-7)
        if not going.any():
            return
        at = at + said[AWAY.name]
        joints = np.stack([said[f"found_{j.symbol.name}"] for j in both.mechanism.joints], axis=1)
        yield from ((row, np.degrees(joints[row])) for row in np.flatnonzero(going))
    raise AssertionError("the search does not end")
