"""Batches: the lock of Python is free meanwhile, the environment limits the threads, and results do not."""

import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from softkin import Mechanism

from tests.native.machines import native, poses

NAME = "Kin_ArticulatedRobot_6DOF"
ROWS = 20_000
UNTOUCHED = 255


@pytest.fixture(scope="module")
def asked() -> tuple[Mechanism, Any]:
    """A machine and many poses of it."""
    robot = native(NAME)
    return robot, robot.forward_batch(np.random.default_rng(2).uniform(-170.0, 170.0, (ROWS, 6)))


@pytest.mark.parametrize("threads", ["1", "2", "3", "16", ""])
def test_any_number_of_threads(asked: Any, threads: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same bytes, whoever computes a row."""
    robot, (positions, rotations, configurations, _) = asked
    monkeypatch.setenv("SOFTKIN_THREADS", "1")
    calls = [
        (robot.inverse_batch, (positions, rotations, configurations)),
        (robot.inverse_all_batch, (positions, rotations)),
    ]
    expected = [call(*given) for call, given in calls]
    monkeypatch.setenv("SOFTKIN_THREADS", threads)
    for (call, given), (values, statuses) in zip(calls, expected, strict=True):
        found, codes = call(*given)
        assert found.tobytes() == values.tobytes() and codes.tobytes() == statuses.tobytes()


@pytest.mark.parametrize("wrong", ["0", "-1", "two", "1.5", " "])
def test_a_wrong_limit_is_an_error(asked: Any, wrong: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """And says which."""
    robot, (positions, rotations, *_) = asked
    monkeypatch.setenv("SOFTKIN_THREADS", wrong)
    with pytest.raises(ValueError, match="SOFTKIN_THREADS must be a whole number of at least 1"):
        robot.inverse_batch(positions, rotations)


def test_as_many_threads_as_are_allowed(asked: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Several solve, or the caller alone."""
    robot, (positions, rotations, *_) = asked
    seen: set[int] = set()

    class Watched:
        answers, is_searched = True, False

        def inverse_rows(self, *_: Any) -> None:
            seen.add(threading.get_ident())
            time.sleep(0.02)

    from softkin import _native_batch

    class Machine:
        _machine, AXES, CONFIGURATION = Watched(), robot.AXES, robot.CONFIGURATION
        READS_ROTATION, DEFAULT_CONFIGURATION, NAME = True, robot.DEFAULT_CONFIGURATION, robot.NAME

        def _without_reference(self) -> tuple[float, ...]:
            return (0.0,) * 6

    for limit, least, most in (("1", 1, 1), ("2", 2, 2), ("3", 2, 3)):
        monkeypatch.setenv("SOFTKIN_THREADS", limit)
        seen.clear()
        _native_batch.inverse(Machine(), positions, rotations, None, None)  # type: ignore[arg-type]
        assert least <= len(seen) <= most
        assert (threading.get_ident() in seen) == (limit == "1")


def test_the_lock_is_free_meanwhile(asked: Any) -> None:
    """Another thread of Python goes on while rows are computed; otherwise it would wait for the end of the call."""
    robot, (positions, rotations, *_) = asked
    turns, near = np.ascontiguousarray(rotations.reshape(-1, 9)), np.zeros((ROWS, 6))
    axes, statuses = np.empty((ROWS, 8, 6)), np.full((ROWS, 8), UNTOUCHED, np.uint8)
    given = (positions, turns, near, axes, statuses, 0, ROWS)
    last = memoryview(statuses)
    worker = threading.Thread(target=lambda: robot._machine.inverse_all_rows(*given))
    interval = sys.getswitchinterval()
    sys.setswitchinterval(2.0)  # who holds the lock keeps it for so long, unless he gives it back
    try:
        worker.start()
        seen_meanwhile = 0
        while last[ROWS - 1, 7] == UNTOUCHED:
            seen_meanwhile += statuses[0, 0] != UNTOUCHED
        worker.join()
    finally:
        sys.setswitchinterval(interval)
    assert seen_meanwhile > 10


def test_single_calls_from_many_threads() -> None:
    """One machine serves them all."""
    robot = native(NAME)
    given = [(frame, robot.forward(axes)[1]) for axes, frame in poses(NAME, 20)]
    expected = [robot.inverse(*one) for one in given]

    def ask(_: int) -> bool:
        return all([robot.inverse(*one) for one in given] == expected for _ in range(50))

    with ThreadPoolExecutor(8) as pool:
        assert all(pool.map(ask, range(16)))
