"""The compiler of robot kinematics: from a mechanism's equations to proven Python and Structured Text."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

    from derive.description.mechanism import Mechanism

# SymPy remembers what it computed, as a rule the last thousand results: a derivation asks again for more than that.
os.environ.setdefault("SYMPY_CACHE_SIZE", "None")

__all__ = ["compile_mechanism"]


def compile_mechanism(description: Mechanism | str | Path) -> type[Any]:
    """A class of `softkin` for a description, or for the path of the file that holds one.

    The class has all that the generated ones have: it is made of the same text, and was measured by the same witness.
    Two compilations give two classes, whatever their names; `softkin.catalogue()` holds neither. Raises
    `DescriptionError`, `Unsolved` or `Disagreement` with what is wrong and what to do, where the machine cannot be
    derived, and `GenerationError` where an installed `softkin` was written by another version of the compiler.
    """
    from derive.live import compiled  # the compiler is loaded when it is used

    return compiled(description)
