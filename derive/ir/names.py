"""Names that are free: different from all that are taken, even where a language joins the words of a name."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from derive.ir.program import (
    Program,
)
from derive.ir.symbols import (
    called,
    real,
)


class Names:
    """The names that are taken: a new one is taken from then on."""

    def __init__(self, taken: Iterable[str]) -> None:
        """taken: with words between underscores, as every name of a program."""
        self._joined = {name.replace("_", "") for name in taken}

    @classmethod
    def of(cls, program: Program) -> Names:
        """Those that a program reads or binds."""
        return cls(s.name for s in (*program.inputs, *program.bound()))

    def fresh(self, proposal: str, like: sp.Symbol | None = None) -> sp.Symbol:
        """The proposal, with a number behind it where it is taken. like: a name of the same type, else it is a real
        number.
        """
        number, name = 1, proposal
        while name.replace("_", "") in self._joined:
            number += 1
            name = f"{proposal}_{number}"
        self._joined.add(name.replace("_", ""))
        return real(name) if like is None else called(name, like)
