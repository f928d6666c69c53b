"""The processes that derive are no copies of the one that asks them."""

from threading import Lock

from derive.pipeline import workers

HELD = Lock()


def is_free() -> bool:
    return HELD.acquire(blocking=False)


def test_a_lock_that_is_held_here_is_free_there() -> None:
    """A copy would have the lock as it is here, and nobody who releases it."""
    with HELD, workers(1) as pool:
        assert pool.submit(is_free).result(timeout=60)
