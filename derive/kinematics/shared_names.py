"""Find an input and a value of a derivation with the same name: a program could not tell the two apart.

Where they meet, the mechanism is derived again with another name for the input inside.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from typing import TypeVar

import sympy as sp

from derive.description.mechanism import DescriptionError, Mechanism
from derive.form.inner_names import in_given_names, inputs_named, joined, suspects, with_inner_names
from derive.ir.program import Program, Statement, shared
from derive.ir.symbols import cosine, sine
from derive.ir.verify import BrokenProgram, RepeatedName
from derive.solver.solve import MOST_TERMS
from derive.solver.unsolved import Exhausted, Unsolved
from derive.work import TooMuchWork, Work, at_most

Found = TypeVar("Found")
_ATTEMPTS = 4
"""The largest number of times that an input gets another name."""
_MOST_TERMS = 6 * MOST_TERMS
"""The work of a whole derivation, of all its stages and attempts."""
_SMALLER = (
    "state the dimensions that never change as numbers, leave out those that are zero, or make neighbouring axes "
    "parallel or perpendicular"
)


class SharedName(DescriptionError):
    """A parameter has the name of a value of the derivation."""

    def __init__(self, message: str, name: str = "") -> None:
        """name: the name of the parameter inside the derivation."""
        super().__init__(message)
        self.names = (name,)


def refuse_shared_names(mechanism: Mechanism, statements: Iterable[Statement]) -> None:
    """Refuse a parameter named like a value of the derivation, or of a program that it calls."""
    own = Program("derivation", (), tuple(statements), ())
    programs = (own, *shared([own]))
    given = (name for p in programs for call in p.calls() for name, _ in call.given)
    refuse_names(mechanism, (*given, *(name for p in programs for name in p.bound())))


def refuse_names_of_joints(mechanism: Mechanism) -> None:
    """Refuse a parameter named like a joint, its sine or its cosine, before anything is derived from them."""
    refuse_names(mechanism, (name for j in mechanism.joints for name in (j.symbol, sine(j.symbol), cosine(j.symbol))))


def refuse_names(mechanism: Mechanism, names: Iterable[sp.Symbol]) -> None:
    """Refuse a parameter with one of these names."""
    parameters = {joined(p.name): p.name for p in mechanism.parameters}
    for name in names:
        if own := parameters.get(joined(name.name)):
            raise SharedName(f"parameter {own!r} has a name that the derivation itself uses: choose another", own)


def with_free_names(mechanism: Mechanism, derived: Callable[[Mapping[str, int]], Found]) -> Found:
    """The result of `derived`, given the symbols of inputs that need another name inside, and the number of attempts.

    Raises the errors of `derived`, in the names of the description, and `Exhausted` where it is too much work.
    """
    further: Counter[str] = Counter()
    done = 0
    while True:
        work = Work()
        try:
            with at_most(_MOST_TERMS - done, work):
                return derived(further)
        except TooMuchWork as problem:
            raise Exhausted(f"{problem}: {_SMALLER}") from None
        except (Unsolved, DescriptionError, BrokenProgram) as problem:
            inner = with_inner_names(mechanism, further)
            met = {name for name in _met(mechanism, inner, problem) if further[name] < _ATTEMPTS}
            done += work.done
            if not met or done > MOST_TERMS:  # where much was tried, a name was not the reason
                said = in_given_names(str(problem), inner)
                if said == str(problem):
                    raise
                raise type(problem)(said) from None
        further.update(met)


def _met(mechanism: Mechanism, inner: Mechanism, problem: Exception) -> frozenset[str]:
    """The inputs whose names a derivation uses, or may use where it failed."""
    if isinstance(problem, SharedName | RepeatedName):
        return inputs_named(mechanism, inner, problem.names)
    return suspects(inner)
