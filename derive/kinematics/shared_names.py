"""Refuse a parameter and a value of a derivation with the same name: a program could not tell the two apart."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from derive.description.mechanism import DescriptionError, Mechanism
from derive.ir.program import Let, Statement
from derive.ir.symbols import cosine, sine


def refuse_shared_names(mechanism: Mechanism, statements: Iterable[Statement]) -> None:
    """Refuse a parameter named like a value of the derivation."""
    refuse_names(mechanism, (s.name for s in statements if isinstance(s, Let)))


def refuse_names_of_joints(mechanism: Mechanism) -> None:
    """Refuse a parameter named like a joint, its sine or its cosine, before anything is derived from them."""
    refuse_names(mechanism, (name for j in mechanism.joints for name in (j.symbol, sine(j.symbol), cosine(j.symbol))))


def refuse_names(mechanism: Mechanism, names: Iterable[sp.Symbol]) -> None:
    """Refuse a parameter with one of these names."""
    parameters = {_key(p.name): p.name for p in mechanism.parameters}
    for name in names:
        if own := parameters.get(_key(name.name)):
            raise DescriptionError(f"parameter {own!r} has a name that the derivation itself uses: choose another")


def _key(name: str) -> str:
    """The name as Structured Text compares it, where words are joined."""
    return name.replace("_", "")
