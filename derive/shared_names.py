"""Names that two things would share: in a program a name is a name, and the two would become one."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import combinations

from derive.composite import name_of
from derive.mechanism import DescriptionError, Mechanism
from derive.program import Let, Statement


def refuse_shared_names(mechanism: Mechanism, statements: Iterable[Statement]) -> None:
    """Refuse a parameter named like a value of the derivation, and a joint named like a sum of others."""
    parameters = {_key(p.name): p.name for p in mechanism.parameters}
    for statement in statements:
        if isinstance(statement, Let) and _key(statement.name.name) in parameters:
            name = parameters[_key(statement.name.name)]
            raise DescriptionError(f"parameter {name!r} has a name that the derivation itself uses: choose another")
    turning = [j for j in mechanism.joints if j.is_angle]
    sums = {name_of(tuple((j.symbol, 1) for j in c)) for n in range(2, len(turning) + 1) for c in combinations(turning, n)}
    for joint in mechanism.joints:
        if joint.symbol.name in sums:
            raise DescriptionError(f"joint {joint.name!r} has the name of a sum of other joints: choose another")


def _key(name: str) -> str:
    """Structured Text joins the words of a name."""
    return name.replace("_", "")
