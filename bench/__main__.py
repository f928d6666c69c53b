"""`make bench`: times of all contenders, taken in turns, with the worst error and the lost poses beside each."""

from __future__ import annotations

import gc
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from bench.chain import KR6_R900, UR5, Array, Table, errors
from bench.contenders import ALL, BATCH, FORWARD, ONE, Contender, contenders

ROUNDS, BATCH_ROUNDS = 60, 8
SCALAR, ROWS = 200, 100_000
WARMING = 40
SOLVED = 1e-6
"""An answer is right where it misses by less (metres, parts of one); a pose without one is lost."""


@dataclass(frozen=True)
class Quality:
    """What the answers to some poses are worth."""

    worst: float
    """By how much the worst of the right answers misses."""
    lost: int
    """Poses without a right answer."""
    answers: float
    """Right ones a pose."""
    wrong: int
    """Answers that are none."""


def main() -> None:
    """Measure and print."""
    print(
        f"Python {sys.version.split()[0]}, NumPy {np.__version__}; least of {ROUNDS} rounds ({BATCH_ROUNDS} of "
        f"batches)."
    )
    print(
        f"Poses: {SCALAR} random, a call each behind {WARMING} others; {ROWS} random, one call; 4096 of a grid for "
        f"quality."
    )
    for table in (KR6_R900, UR5):
        report(table)


def report(table: Table) -> None:
    """All tasks of a robot."""
    random = np.random.default_rng(5)
    few, many = (table.frames(random.uniform(-170.0, 170.0, (n, 6))) for n in (SCALAR, ROWS))
    grid = table.frames(np.array(list(product((-90.0, 0.0, 90.0, 180.0), repeat=6))))
    found = contenders(table)
    times = measured(found, few, many)
    print(f"\n{table.name}")
    print(f"{'':52}{'':17}{'random poses':>28}{'90-degree grid':>28}")
    columns = f"{'worst':>9}{'answers':>8}{'lost':>5}{'wrong':>6}"
    print(f"{'':52}{'µs a pose':>10}{'ratio':>7}{columns}{columns}")
    for task in (ALL, ONE, FORWARD, BATCH):
        of_all = task in (ONE, FORWARD)
        peers = [times[c.name] for c in found if c.is_peer and c.task == (ALL if of_all else task)]
        print(f"{task}; ratio to the fastest peer" + (" with all solutions" if of_all else ""))
        for contender in (c for c in found if c.task == task):
            took = times[contender.name]
            if task == FORWARD:
                print(f"  {contender.name:50}{took:10.2f}{took / min(peers):7.2f}")
                continue
            good, gridded = (quality(table, contender, poses) for poses in (few, grid))
            print(
                f"  {contender.name:50}{took:10.2f}{took / min(peers):7.2f}"
                + "".join(f"{q.worst:9.0e}{q.answers:8.2f}{q.lost:5d}{q.wrong:6d}" for q in (good, gridded))
            )


def measured(found: Sequence[Contender], few: Array, many: Array) -> dict[str, float]:
    """Microseconds a pose, the least of all rounds; in each round every contender has its turn."""
    inputs = {c.name: c.inputs(many if c.task == BATCH else few) for c in found}
    least = {c.name: np.inf for c in found}
    for k in range(ROUNDS):
        for contender in found:
            if contender.task == BATCH and k >= BATCH_ROUNDS:
                continue
            gc.collect()
            gc.disable()
            took = _once(contender, inputs[contender.name])
            gc.enable()
            least[contender.name] = min(least[contender.name], took)
    return least


def _once(contender: Contender, given: Any) -> float:
    """Some calls go before the clock runs: the collection has emptied the caches, which an inner loop finds full.

    Of a batch the processor time of all threads counts: cores that others use give no others.
    """
    call = contender.call
    if contender.task != BATCH:
        for one in given[:WARMING]:
            _answer(contender, one)
    if contender.task == BATCH:
        start = time.process_time()
        call(given)
        return (time.process_time() - start) / ROWS * 1e6
    start = time.perf_counter()
    if contender.task == ONE:
        for pose, selection in given:
            call(pose, selection)
    else:
        for pose in given:
            call(pose)
    return (time.perf_counter() - start) / len(given) * 1e6


def _answer(contender: Contender, one: Any) -> Any:
    """What a call answers; None where it refuses."""
    try:
        return contender.call(*one) if contender.task == ONE else contender.call(one)
    except (ValueError, ZeroDivisionError):
        return None


def quality(table: Table, contender: Contender, poses: Array) -> Quality:
    """What a contender's answers to poses are worth, by the table."""
    given = contender.inputs(poses)
    result = contender.call(given) if contender.task == BATCH else [_answer(contender, one) for one in given]
    axes, pose = contender.answers(result)
    missed = errors(table, axes, poses[pose])
    is_right = missed < SOLVED
    lost = len(poses) - len(np.unique(pose[is_right]))
    return Quality(float(missed[is_right].max(initial=0.0)), lost, is_right.sum() / len(poses), int(np.sum(~is_right)))


if __name__ == "__main__":
    main()
