"""Algebra finds what the scan finds, and no more; and the root nearest to a start, also where roots are nearly one."""

from collections.abc import Iterator
from dataclasses import replace
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
    given = given_of(case) | {wanted(b).name: np.asarray(signs.get(b.name, 0)) for b in both.mechanism.branches}
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


@pytest.mark.sweep
@pytest.mark.parametrize("kind", ("straight wrist", "elbow", "both"))
@pytest.mark.parametrize("lateral", (1e-6, 8.0, -300.0))
def test_no_planted_pose_is_lost(kind: str, lateral: float) -> None:
    check_the_nearest(planted(kind, lateral, 60, 12))


def test_poses_that_were_lost() -> None:
    """Folded elbows, where two solutions are nearly one: with a bound of the rounding 30 times as narrow."""
    case = planted("elbow", 1e-6, 1, 12)
    first = (20.680794604651624, 76.57934454864488, 94.7636416907313)
    second = (26.48570533757851, 89.47374945542157, 94.76364166896298)
    axes = np.array([
        (*first, 107.1833586205289, 16.626697271521323, 136.68956252099952),
        (*second, 157.170767660695, -90.00073747891325, -156.4431330836475),
    ])  # fmt: skip
    for turns in (0.0, 720.0):
        check_the_nearest(replace(case, axes=axes, references=np.full_like(axes, turns)))
    check_the_nearest(replace(case, axes=axes, references=np.zeros_like(axes)), unit=1e-3)


def check_the_nearest(case: Planted, unit: float = 1.0) -> None:
    """Every pose is met on its own branch, with the searched joint no further from its reference than the planted one.

    unit: the lengths of the arm are multiplied by it.
    """
    lengths = {k: v * unit for k, v in {**ARM, "j6_offset_x": case.lateral}.items()}
    case = replace(case, robot=type(case.robot)(**lengths), lateral=case.lateral * unit)
    both, find = machine()
    mechanism = both.mechanism
    pose, starts = case.robot.forward_batch(case.axes), np.radians(case.references)
    # a byte where two branches meet says neither: the margins do
    signs = np.array([[1 if m >= 0.0 else -1 for m in case.robot._forward(tuple(axes))[2]] for axes in case.axes])
    given = given_of(case, unit) | {wanted(b).name: signs[:, k] for k, b in enumerate(mechanism.branches)}
    given |= {reference_value(j).name: starts[:, k] for k, j in enumerate(mechanism.joints)}
    given |= {START.name: starts[:, 5], LOOKED_FOR.name: np.asarray(True), ONWARD.name: np.asarray(False)}
    said, _ = run(find, given)
    assert said["found"].all(), case.axes[~said["found"]][:1].tolist()
    found = np.degrees(np.stack([said[f"found_{j.symbol.name}"] for j in mechanism.joints], axis=1))
    reached = case.robot.forward_batch(found)
    assert np.abs(reached[0] - pose[0]).max() < 1e-8 * lengths["d1"]
    assert np.abs(reached[1] - pose[1]).max() < 1e-10
    away, planted_away = (np.abs((a[:, 5] - case.references[:, 5] + 180.0) % 360.0 - 180.0) for a in (found, case.axes))
    assert (away < planted_away + 1e-4).all()


def given_of(case: Planted, unit: float = 1.0) -> dict[str, Array]:
    """The machine and its poses, as the search is given them."""
    both, _ = machine()
    positions, rotations, _, _ = case.robot.forward_batch(case.axes)
    given = {k: np.asarray(v * unit) for k, v in ARM.items()} | {"j6_offset_x": np.asarray(case.lateral)}
    scale = normalise("scale", [], [Output("scale", machine_scale(both.mechanism))])
    given["machine_scale"] = run(scale, given)[0]["scale"] * 1.0
    given |= {f"goal_{c}": positions[:, k] for k, c in enumerate("xyz")}
    return given | {f"goal_r{i + 1}{j + 1}": rotations[:, i, j] for i, j in product(range(3), repeat=2)}
