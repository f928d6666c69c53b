"""Refuse a parameter and a value of a derivation with the same name: a program could not tell the two apart."""

from __future__ import annotations

from collections.abc import Iterable

from derive.description.mechanism import DescriptionError, Mechanism
from derive.ir.program import Let, Statement


def refuse_shared_names(mechanism: Mechanism, statements: Iterable[Statement]) -> None:
    """Refuse a parameter named like a value of the derivation."""
    parameters = {_key(p.name): p.name for p in mechanism.parameters}
    for statement in statements:
        if isinstance(statement, Let) and _key(statement.name.name) in parameters:
            name = parameters[_key(statement.name.name)]
            raise DescriptionError(f"parameter {name!r} has a name that the derivation itself uses: choose another")


def _key(name: str) -> str:
    """The name as Structured Text compares it, where words are joined."""
    return name.replace("_", "")
