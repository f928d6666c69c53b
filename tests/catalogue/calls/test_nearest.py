"""The nearest solution inside the limits, against every slot on every turn."""

from collections.abc import Iterator
from itertools import product

import numpy as np
import pytest
import softkin
from numpy.typing import NDArray
from softkin import KinematicsError, Status
from softkin._nearest import _Search
from softkin._start import IterativeForward

from tests.catalogue.calls.mountings import NAMES, Axes, drawn_limits, frame_at, poses, robots, with_limits
from tests.catalogue.refusals import refusal
from tests.corpus.dimensions import DIMENSIONS
from tests.corpus.robots import Robot
from tests.mechanisms import in_the_task

Array = NDArray[np.float64]
POSES = 2
TURNS = range(-2, 3)
NUMBERS = (-3, -2, -1, 1, 2, 3)
TIE = 1e-6


def free(one: softkin.Mechanism) -> softkin.Mechanism:
    """The machine without limits."""
    if isinstance(one, softkin.Coupled):
        return softkin.Coupled(free(one.position_part), free(one.orientation_part))
    return one.changed(check_limits=False)


def every_slot(one: softkin.Mechanism, frame: softkin.Frame, near: Axes) -> Iterator[tuple[softkin.Solution, Axes]]:
    for slot in one.inverse_all(frame, near):
        for axes in () if slot.axes is None else (slot.axes, *slot.others):
            yield slot, axes


def by_naming(
    one: softkin.Mechanism, frame: softkin.Frame, near: Axes, numbers: tuple[int, ...] = NUMBERS
) -> list[Axes]:
    """Every slot on every turn, by its number: the limits are those of the machine."""
    found = []
    turning = one._period_bytes
    for slot in one.inverse_all(frame, near):
        for turns in product(numbers, repeat=len(turning)):
            named = list(slot.configuration)
            for place, turn in zip(turning, turns, strict=True):
                named[place] = turn
            try:
                found.append(one.inverse(frame, named, near))
            except KinematicsError as error:
                assert error.status in (Status.UNREACHABLE, Status.IMPOSSIBLE)
    return found


def by_adding(one: softkin.Mechanism, frame: softkin.Frame, near: Axes) -> list[Axes]:
    """Every slot of the machine without limits, and whole turns of its axes, inside the limits."""
    turns = TURNS if len(one.PERIOD_AXES) < 5 else range(-1, 2)
    low, high = np.array(one._ranges()[: len(near)]).reshape(-1, 2).T
    shifts = np.zeros((len(turns) ** len(one.PERIOD_AXES), len(near)))
    shifts[:, list(one.PERIOD_AXES)] = 360.0 * np.array(list(product(turns, repeat=len(one.PERIOD_AXES))))
    found: list[Axes] = []
    for _, axes in every_slot(free(one), frame, near):
        every = np.array(axes) + shifts
        found += map(tuple, every[((every >= low) & (every <= high)).all(axis=1)])
    return found


def distance(one: softkin.Mechanism, axes: Axes, near: Axes, weights: Array | None, measure: str) -> float:
    """The distance in words of the documentation."""
    factors = np.zeros(len(axes))
    factors[list(one._criteria[0].axes)] = 1.0
    apart = (factors if weights is None else weights) * (np.array(axes) - near)
    return float(np.abs(apart).max(initial=0.0) if measure == "largest" else (apart * apart).sum())


def answered(
    one: softkin.Mechanism, frame: softkin.Frame, near: Axes, weights: Array | None, measure: str
) -> Axes | None:
    """What `nearest` answers; None where it refuses, with a reason."""
    try:
        found = one.nearest(frame, near, weights=weights, measure=measure)  # type: ignore[arg-type]
    except KinematicsError as error:
        assert error.status in (Status.UNREACHABLE, Status.IMPOSSIBLE)
        assert error.refusal is not None and error.refusal.reason and error.refusal.in_words in str(error)
        return None
    return found


def check(one: Robot, made: softkin.Mechanism, start: Axes, near: Axes, weights: Array | None, measure: str) -> bool:
    """The answer is a solution inside the limits, and no candidate is nearer."""
    frame = frame_at(made, start)
    few = len(made.PERIOD_AXES) <= 1 or any(j.kind == "helical" for j in made.AXES) or len(made._ranges()) > len(near)
    numbers = NUMBERS if len(made.PERIOD_AXES) < 5 else NUMBERS[1:-1]  # of five axes 1024 sums in place of 7776
    truth = by_naming(made, frame, near, numbers) if few else by_adding(made, frame, near)
    found = answered(made, frame, near, weights, measure)
    if found is None:
        assert not truth
        return False
    assert made._beyond_limits(found) is None
    if made.ROLE != "orientation" and not isinstance(made, IterativeForward):
        reached = frame_at(made, found)
        size = one.reach + max(map(abs, found))
        shift = np.subtract(reached.position, frame.position)
        assert np.abs(in_the_task(made.NAME, shift)).max() < 1e-9 * size
    slots = every_slot(free(made), frame, found)
    assert any(np.abs(np.subtract(axes, found)).max(initial=0.0) < 1e-6 for _, axes in slots)
    own = distance(made, found, near, weights, measure)
    if not truth:
        return True  # on turns that the truth does not look at
    least = min(distance(made, axes, near, weights, measure) for axes in truth)
    scale = 1.0 if weights is None else max(1.0, float(weights.max(initial=0.0)) ** 2)
    assert own <= least + (2e-3 if measure == "largest" else 2 * TIE) * scale + 1e-9 * own, (found, truth[:3])
    return True


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("name", NAMES)
def test_no_solution_is_nearer(name: str) -> None:
    """Random limits, references on other turns, both measures, with weights and without."""
    rng = np.random.default_rng(3)
    outcomes = []
    for number, one in enumerate(robots(name)):
        for axes in poses(name, number, POSES):
            made = with_limits(one.made, drawn_limits(one, axes, rng))
            size = np.where(one.is_angle, 400.0, 0.3 * one.reach)
            near = np.array(axes) + rng.uniform(-1.0, 1.0, len(axes)) * size
            near[list(made.HELD)] = np.array(axes)[list(made.HELD)]
            weights = rng.uniform(0.1, 2.0, len(axes)) if rng.random() < 0.5 else None
            measure = "largest" if rng.random() < 0.4 else "squares"
            outcomes.append(check(one, made, axes, tuple(near.tolist()), weights, measure))
            outcomes.append(check(one, one.made, axes, tuple(near.tolist()), None, "squares"))
    assert any(outcomes)


@pytest.mark.long("Ac6")
@pytest.mark.parametrize("name", NAMES)
def test_a_batch_is_the_scalar_calls(name: str) -> None:
    """Rows inside and beyond limits, out of reach, with garbage."""
    rng = np.random.default_rng(4)
    for number, one in enumerate(robots(name)):
        chosen = poses(name, number, POSES)
        made = with_limits(one.made, drawn_limits(one, chosen[0], rng))
        frames = [frame_at(made, axes) for axes in chosen for _ in range(3)]
        positions, rotations = (np.array(part) for part in zip(*frames, strict=True))
        near = np.repeat(np.array(chosen), 3, axis=0) + np.where(one.is_angle, 300.0, 0.0) * rng.uniform(
            -1.0, 1.0, (len(frames), len(one.is_angle))
        )
        positions[3] *= 50.0
        rotations[4] *= 3.0
        if near.shape[1]:
            near[5, 0] = np.nan
        for measure in ("squares", "largest"):
            found, statuses = made.nearest_batch(positions, rotations, near, measure=measure)  # type: ignore[arg-type]
            assert found.shape == near.shape and statuses.shape == (len(near),)
            for row in range(len(near)):
                try:
                    scalar = made.nearest((positions[row], rotations[row]), near[row], measure=measure)  # type: ignore[arg-type]
                except KinematicsError as error:
                    assert statuses[row] == error.status, (row, error)
                    assert np.isnan(found[row]).all()
                else:
                    assert statuses[row] == Status.OK
                    assert np.abs(np.subtract(scalar, found[row])).max(initial=0.0) < 1e-6


def test_the_nearest_miss() -> None:
    """The limit that is exceeded least gives the reason; out of reach, the missing amount."""
    robot = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=200.0, limits={"A1": (-10.0, 10.0), "A2": (-30.0, 300.0)})
    frame = softkin.Scara2Z(arm_length_1=300.0, arm_length_2=200.0).forward((12.0, -50.0, 0.0))[0]
    says = r"A1: above its upper limit, missing 2\.0 deg"
    assert refusal(robot.nearest, frame, (0.0, 0.0, 0.0), says=says) is Status.UNREACHABLE
    with pytest.raises(KinematicsError, match=r"A2: out of reach, missing 50\.0 u"):
        robot.nearest(((550.0, 0.0, 0.0), frame.rotation), (0.0, 0.0, 0.0))


def test_no_turn_is_tried_where_another_axis_is_outside_its_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Turns of both arms move their elbow; none of them moves the column."""
    robot = softkin.catalogue()["Softkin_Palletizer"](
        **DIMENSIONS["Softkin_Palletizer"], lower_a1=100.0, upper_a1=120.0
    )
    tried = list[object]()
    search = _Search._level
    monkeypatch.setattr(_Search, "_level", lambda *given: (tried.append(given), search(*given)))
    for column in (10.0, 110.0):
        frame = robot.forward((column, 20.0, 30.0, 40.0))[0]
        is_inside = column > 100.0
        if is_inside:
            assert robot.nearest(frame, (0.0,) * 4) == pytest.approx((column, 20.0, 30.0, 40.0))
        else:
            assert refusal(robot.nearest, frame, (0.0,) * 4, says="A1: ") is Status.UNREACHABLE
        assert bool(tried) == is_inside


def test_what_is_refused() -> None:
    robot = softkin.Gantry2()
    frame = robot.forward((1.0, 2.0))[0]
    for given in ({"weights": (1.0,)}, {"weights": (-1.0, 1.0)}, {"measure": "sum"}, {"weights": "12"}):
        assert refusal(robot.nearest, frame, (0.0, 0.0), **given) is Status.BAD_INPUT
    for near in ((0.0,), (0.0, float("nan")), (0.0, 1e300)):
        assert refusal(robot.nearest, frame, near) is Status.BAD_INPUT


def test_an_axis_that_is_free_keeps_to_its_limits() -> None:
    """A straight wrist, with the reference beyond the limits of the axis that the pose leaves free."""
    free = softkin.Scara3ZCCC(link_length_1=300.0, link_length_2=300.0, link_length_3=50.0)
    robot = free.changed(limits={"A2": (-60.0, 60.0)})
    frame = robot.forward((0.0, 20.0, 180.0, 0.0))[0]  # the wrist is on axis A2
    found = robot.nearest(frame, (0.0, 130.0, 180.0, 0.0))
    assert found[1] == pytest.approx(60) and robot.forward(found)[0].position == pytest.approx(frame.position, abs=1e-9)
