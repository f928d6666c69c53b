"""Results that are kept by the identity of what they were computed from.

Programs and mechanisms never change, and to compare two of them takes about as long as to compute the results.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar

Given = TypeVar("Given")
Result = TypeVar("Result")


def kept_by_identity(most: int) -> Callable[[Callable[[Given], Result]], Callable[[Given], Result]]:
    """A decorator for a pure function of one object: results are kept for at most so many objects, then all dropped."""

    def decorate(function: Callable[[Given], Result]) -> Callable[[Given], Result]:
        kept: dict[int, tuple[Given, Result]] = {}  # with the object itself, so that no other gets its identity

        @wraps(function)
        def answer(given: Given) -> Result:
            found = kept.get(id(given))
            if found is None:
                result = function(given)
                if len(kept) >= most:
                    kept.clear()
                kept[id(given)] = found = (given, result)
            return found[1]

        return answer

    return decorate
