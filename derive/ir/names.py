"""New names that differ from all names in use, even where a language joins the words of a name."""

from __future__ import annotations

from collections.abc import Iterable

import sympy as sp

from derive.ir.program import Program
from derive.ir.symbols import called, real

_LONGEST = 80
"""The most letters of a new name, without its number."""


class Names:
    """The names in use. A new name is in use as soon as it has been made."""

    def __init__(self, taken: Iterable[str]) -> None:
        """taken: the names in use, written as a program writes them, with underscores between words."""
        self._joined = {name.replace("_", "") for name in taken}

    @classmethod
    def of(cls, program: Program) -> Names:
        """The names that a program reads or binds."""
        return cls(s.name for s in (*program.inputs, *program.bound()))

    def fresh(self, proposal: str, like: sp.Symbol | None = None) -> sp.Symbol:
        """The proposed name, shortened if it is too long, and followed by a number if it is in use.

        like: a symbol whose type the new name gets; without it the new name is a real number.
        """
        if len(proposal) > _LONGEST:  # its begin says what the value is, its end where it belongs
            begin, end = proposal[: _LONGEST // 2], proposal[-_LONGEST // 2 :]
            proposal = f"{begin.rpartition('_')[0] or begin}_{end.partition('_')[2] or end}"
        number, name = 1, proposal
        while name.replace("_", "") in self._joined:
            number += 1
            name = f"{proposal}_{number}"
        self._joined.add(name.replace("_", ""))
        return real(name) if like is None else called(name, like)
