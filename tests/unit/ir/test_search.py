"""The root scan, on trials with known roots: on arrays, and on plain numbers."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from softkin._root import every_root
from softkin._roots import CELLS

from derive.ir.cells import At
from derive.ir.roots import find_roots, nearest

Array = NDArray[np.float64]
Trial = Callable[[Array, Array, Array, Array], tuple[Array, ...]]
"""joint, side, freed, angle → value, slope, guard, slope of the guard, directions."""


def on_arrays(trial: Trial, start: float) -> list[tuple[float, float, float]]:
    """Joint, side and free angle of all candidates."""

    def at(place: At) -> Array:
        said = trial(place.joint, place.side, place.freed.astype(float), place.angle)
        return np.stack([np.broadcast_to(v, place.joint.shape) for v in said], axis=1)

    found = find_roots(at, np.array([start]))
    return list(zip(found.joint.tolist(), found.side.tolist(), found.angle.tolist(), strict=True))


def on_numbers(trial: Trial, start: float) -> list[tuple[float, float, float]]:
    """The same by the search on plain numbers."""

    def one(given: tuple[float, ...]) -> tuple[float, ...]:
        return tuple(float(v) for v in trial(*(np.float64(g) for g in given)))

    def accept(given: tuple[float, ...]) -> tuple[float, ...]:
        return (1.0, given[0], given[1], given[3])

    place = ("tried", "side", "freed", "freed_angle")
    found = every_root(one, accept, start, True, place, place, 4, lambda given, _: trial(*given))
    return [(joint, side, angle) for joint, side, angle in found]


BOTH = pytest.mark.parametrize("search", (on_arrays, on_numbers))


def free_of_guard(value: Callable[[Array], Array], slope: Callable[[Array], Array]) -> Trial:
    return lambda t, side, freed, angle: (value(t), slope(t), np.ones_like(t), np.zeros_like(t))


def roots_of(found: list[tuple[float, float, float]], value: Callable[[Array], Array]) -> list[float]:
    """The joints around the circle, each once; every candidate must be a root."""
    joints = sorted(t % (2 * np.pi) for t, _, _ in found)
    assert all(abs(value(np.float64(t))) < 1e-11 for t in joints)
    kept: list[float] = []
    for t in joints:
        if not kept or t - kept[-1] > 1e-5:
            kept.append(t)
    return kept[:-1] if len(kept) > 1 and kept[0] + 2 * np.pi - kept[-1] < 1e-5 else kept


@BOTH
@pytest.mark.parametrize("count", (1, 2, 3, 7))
@pytest.mark.parametrize("start", (-3.0, 0.1, 1.5))
def test_simple_roots(
    search: Callable[[Trial, float], list[tuple[float, float, float]]], count: int, start: float
) -> None:
    """The scan finds all simple roots, from any start."""
    found = search(free_of_guard(lambda t: np.sin(count * t + 0.3), lambda t: count * np.cos(count * t + 0.3)), start)
    assert len(roots_of(found, lambda t: np.sin(count * t + 0.3))) == 2 * count


@BOTH
@pytest.mark.parametrize("apart", (0.05, 1e-2, 1e-4))
def test_two_roots_close_to_each_other(
    search: Callable[[Trial, float], list[tuple[float, float, float]]], apart: float
) -> None:
    """cos t - cos(apart / 2) around 0."""
    level = np.cos(apart / 2)
    found = search(free_of_guard(lambda t: np.cos(t) - level, lambda t: -np.sin(t)), 1.234)
    near = sorted((t + np.pi) % (2 * np.pi) - np.pi for t, _, _ in found)
    assert min(near) == pytest.approx(-apart / 2, rel=1e-3)
    assert max(near) == pytest.approx(apart / 2, rel=1e-3)


@BOTH
@pytest.mark.parametrize("apart", (0.05, 1e-2))
def test_three_roots_close_to_each_other(
    search: Callable[[Trial, float], list[tuple[float, float, float]]], apart: float
) -> None:
    """The scan finds three roots that are close to each other."""

    def value(t: Array) -> Array:
        return np.sin(t) * (np.cos(apart) - np.cos(t))

    def slope(t: Array) -> Array:
        return np.cos(t) * (np.cos(apart) - np.cos(t)) + np.sin(t) ** 2

    near = [(t + np.pi) % (2 * np.pi) - np.pi for t, _, _ in search(free_of_guard(value, slope), 0.777)]
    for root in (-apart, 0.0, apart):
        assert min(abs(t - root) for t in near) < 1e-3 * apart


@BOTH
def test_a_root_that_is_touched(search: Callable[[Trial, float], list[tuple[float, float, float]]]) -> None:
    """The scan finds a root at which the value does not change its sign."""
    for start in (0.0, 0.3, 2.0):
        found = search(free_of_guard(lambda t: 1 - np.cos(t), np.sin), start)
        assert found
        assert all(abs((t + np.pi) % (2 * np.pi) - np.pi) < 2e-5 for t, _, _ in found)


@BOTH
def test_no_root(search: Callable[[Trial, float], list[tuple[float, float, float]]]) -> None:
    """The scan finds no root where there is none."""
    assert search(free_of_guard(lambda t: 2 + np.sin(t), np.cos), 0.0) == []


@BOTH
def test_not_a_number_ends(search: Callable[[Trial, float], list[tuple[float, float, float]]]) -> None:
    """The scan ends for a value or a start that is NaN."""
    search(free_of_guard(lambda t: t * np.nan, lambda t: t * np.nan), 0.0)
    search(free_of_guard(np.sin, np.cos), np.nan)


@BOTH
@pytest.mark.parametrize("level", (0.9, 0.0, -0.999, -1 + 1e-6, -1 + 1e-10))
@pytest.mark.parametrize("shift", (0.0, 1e-3, 1e-7))
def test_both_sides_of_a_guard_are_one_curve(
    search: Callable[[Trial, float], list[tuple[float, float, float]]], level: float, shift: float
) -> None:
    """side sqrt(-level - cos t) = shift: reachable around pi alone, where the two sides meet at the ends."""

    def trial(t: Array, side: Array, freed: Array, angle: Array) -> tuple[Array, ...]:
        room = -level - np.cos(t)
        root = np.sqrt(np.maximum(room, 0.0))
        slope = np.where(root > 0, np.sin(t) / np.where(root > 0, 2 * root, 1.0), 0.0)
        return side * root - shift, side * slope, room + 1e-12, np.sin(t)

    if -level <= -1 + shift**2:
        return
    wanted = [t for t, side, _ in search(trial, 0.4) if side > 0 or shift == 0.0]
    ends = np.arccos(-level - shift**2)
    for end in (ends, 2 * np.pi - ends):
        assert min(abs(t % (2 * np.pi) - end) for t in wanted) < 1e-5


@BOTH
@pytest.mark.parametrize("miss", (0.1, 1e-3, 1e-5, 1e-7, 1e-10, 0.0))
def test_a_direction_that_turns_fast(
    search: Callable[[Trial, float], list[tuple[float, float, float]]], miss: float
) -> None:
    """The angle of (sin t, miss) sweeps half a turn around 0; the value is 0 where it is 1 radian."""

    def trial(t: Array, side: Array, freed: Array, angle: Array) -> tuple[Array, ...]:
        length = np.hypot(np.sin(t), miss)
        is_free = (freed >= 0) | (length < 1e-11)
        size = np.where(is_free, 1.0, length)
        c = np.where(is_free, np.cos(angle), np.sin(t) / size)
        s = np.where(is_free, np.sin(angle), miss / size)
        turning = np.where(is_free, 0.0, -np.cos(t) * miss / size**2)
        value = s * np.cos(1.0) - c * np.sin(1.0)
        slope = (c * np.cos(1.0) + s * np.sin(1.0)) * turning
        return value, slope, np.ones_like(t), np.zeros_like(t), c, s

    joint = np.arcsin(miss / np.tan(1.0))
    for start in (0.0, 0.5, 3.0):
        found = search(trial, start)
        away = min(abs((t - joint + np.pi) % (2 * np.pi) - np.pi) for t, _, _ in found)
        assert away < max(1e-6, 1e-9 * joint)
        if miss < 1e-6:
            assert any(
                abs(np.sin(angle - 1.0)) < 1e-9
                for t, _, angle in found
                if abs((t + np.pi) % (2 * np.pi) - np.pi) < 1e-5
            )


def counted(
    trial: Trial, start: float, search: Callable[[Trial, float], list[tuple[float, float, float]]]
) -> tuple[int, list[tuple[float, float, float]]]:
    """The number of trials of a search, and what it finds."""
    asked = 0

    def counting(*place: Array) -> tuple[Array, ...]:
        nonlocal asked
        asked += np.size(place[0])
        return trial(*place)

    found = search(counting, start)
    return asked, found


@BOTH
def test_a_search_does_not_depend_on_its_start(
    search: Callable[[Trial, float], list[tuple[float, float, float]]],
) -> None:
    """Not on the whole turns of a reference, nor on its place: the same candidates, from as many trials. Near the ends
    of the reach the guard is rounding, and takes no trials of its own: a search with a budget would run out of it.
    """

    def trial(t: Array, side: Array, freed: Array, angle: Array) -> tuple[Array, ...]:
        guard = (np.cos(2.0 * t) - 0.2) * 0.37
        ahead = side * np.sqrt(np.maximum(guard, 0.0))
        rate = -0.74 * np.sin(2.0 * t)
        slope = np.where(guard > 0.0, rate / np.where(guard > 0.0, 2.0 * ahead, 1.0), 0.0)
        return ahead - 0.3, slope, guard, rate

    counts, found = set(), set()
    for start in (0.3, 0.3 + 2.0 * np.pi, 0.3 - 4.0 * np.pi, 9.0, -2.0, 217.0):
        asked, places = counted(trial, start, search)
        counts.add(asked)
        found.add(tuple(sorted(round(t, 9) for t, _, _ in places)))
    assert len(counts) == len(found) == 1
    assert counts.pop() < 2 * CELLS + 4 * 20


def test_both_searches_offer_the_same() -> None:
    """The trials between two cells do not depend on how the numbers are arranged."""
    rng = np.random.default_rng(5)
    for _ in range(20):
        a, b, c, d = rng.uniform(-1, 1, 4)

        def value(t: Array, a: float = a, b: float = b, c: float = c, d: float = d) -> Array:
            return a * np.sin(t) + b * np.cos(2 * t) + c * np.sin(3 * t) + d

        def slope(t: Array, a: float = a, b: float = b, c: float = c) -> Array:
            return a * np.cos(t) - 2 * b * np.sin(2 * t) + 3 * c * np.cos(3 * t)

        one, other = (sorted(t for t, _, _ in f(free_of_guard(value, slope), 0.1)) for f in (on_arrays, on_numbers))
        assert np.allclose(one, other, atol=1e-12)
        circle = np.linspace(0.0, 2 * np.pi, 200 * CELLS, endpoint=False) + 0.1
        signs = np.sign(value(circle))
        assert len(roots_of([(t, 1.0, 0.0) for t in one], value)) == np.count_nonzero(signs != np.roll(signs, -1))


@BOTH
@pytest.mark.parametrize("start", (-2.0, 0.3, 0.31, 0.35, 1.7))
@pytest.mark.parametrize("root", (0.02, 0.06, 0.1))
def test_a_direction_that_turns_around_an_end(
    search: Callable[[Trial, float], list[tuple[float, float, float]]], start: float, root: float
) -> None:
    """Both ends of a cell around an end of the reach are at one joint: directions turn on the way there and back."""
    centre, half = 1.0, 0.7

    def trial(t: Array, side: Array, freed: Array, angle: Array) -> tuple[Array, ...]:
        guard, rate = np.cos(t - centre) - np.cos(half), -np.sin(t - centre)
        ahead = side * np.sqrt(np.maximum(guard, 0.0))
        slope = np.where(guard > 0.0, rate / np.where(guard > 0.0, 2.0 * ahead, 1.0), 0.0)
        return ahead - root, slope, guard, rate, np.cos(6.0 * ahead), np.sin(6.0 * ahead)

    away = np.arccos(np.cos(half) + root**2)
    wanted = [t for t, side, _ in search(trial, start) if side > 0]
    for expected in (centre - away, centre + away):
        assert any(abs(np.exp(1j * t) - np.exp(1j * expected)) < 1e-9 for t in wanted)


@pytest.mark.parametrize("apart", (1e-4, 0.3, 1.5, 3.1))
@pytest.mark.parametrize("start", (-2.0, 0.1, 3.0))
@pytest.mark.parametrize("rounding", (-1e-15, 0.0, 1e-15))
def test_of_two_roots_as_near_the_one_ahead_is_taken(apart: float, start: float, rounding: float) -> None:
    """Whatever is rounded: a machine that is symmetric about its start has such roots."""

    def value(t: Array) -> Array:
        return np.asarray(np.cos(t - start - rounding) - np.cos(apart))

    trial = free_of_guard(value, lambda t: -np.sin(t - start - rounding))

    def at(place: At) -> Array:
        said = trial(place.joint, place.side, place.freed.astype(float), place.angle)
        return np.stack([np.broadcast_to(v, place.joint.shape) for v in said], axis=1)

    found, answer = nearest(at, lambda place: (place.side > 0, place.joint[:, None]), np.array([start]))
    assert found.all() and abs(np.exp(1j * answer[0, 0]) - np.exp(1j * (start + apart))) < 1e-9
    joint = on_numbers(trial, start)[0][0]
    assert abs(np.exp(1j * joint) - np.exp(1j * (start + apart))) < 1e-9
