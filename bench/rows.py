"""`python -m bench.rows`: what a pose of a batch takes on the native core, by the number of poses and of threads."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from bench.chain import KR6_R900
from bench.contenders import robot_of

COUNTS = (1_000, 10_000, 100_000, 1_000_000)
ROUNDS = 5
LEAST_ROWS = 100_000
"""A measurement takes as many rows, in several calls where these are small."""


def main() -> None:
    """Print both tables."""
    robot = robot_of(KR6_R900, "native")
    frames = KR6_R900.frames(np.random.default_rng(5).uniform(-170.0, 170.0, (COUNTS[-1], 6)))
    positions, rotations = np.ascontiguousarray(1000.0 * frames[:, :3, 3]), np.ascontiguousarray(frames[:, :3, :3])
    calls = {"one solution": robot.inverse_batch, "every solution": robot.inverse_all_batch}
    print(f"KR6 R900, ns a pose; least of {ROUNDS} rounds; {os.cpu_count()} cores")
    print(f"{'':18}{'threads':>10}" + "".join(f"{f'{count:,} poses':>18}" for count in COUNTS))
    for name, call in calls.items():
        for threads in ("1", ""):
            spent = [_least(call, positions[:n], rotations[:n], threads) for n in COUNTS]
            print(f"{name:18}{threads or 'all':>10}" + "".join(f"{1e9 * s:18.0f}" for s in spent))


def _least(call: Callable[..., Any], positions: Any, rotations: Any, threads: str) -> float:
    """Seconds a pose on the clock."""
    os.environ["SOFTKIN_THREADS"] = threads
    repeats = max(1, LEAST_ROWS // len(positions))
    found = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        for _ in range(repeats):
            call(positions, rotations)
        found.append((time.perf_counter() - start) / repeats / len(positions))
    return min(found)


if __name__ == "__main__":
    main()
