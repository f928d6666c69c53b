"""The compiler of robot kinematics: from a mechanism's equations to proven Python and Structured Text.

ARCHITECTURE.md has a row for each folder. The modules beside these folders:

__main__: `python -m derive`, the same as the command `softkin`
cache: results of earlier runs, kept by the content of everything on which they depend
faults: the cause of a failed derivation: the description, or the compiler
five_axes: five-axis machines by the order of their turning axes, for mechanism files to import
frames: the turns and shifts that make a chain, for mechanism files to import
kept: results that are kept by the identity of what they were computed from
live: a class of `softkin`, made from a description in the running program
mechanism: the vocabulary of a description, for mechanism files to import
output: the output folder, compared with its expected content, or replaced as a whole
pipeline: mechanisms through the folders: derived, measured, drawn, written
program: one degree in radians, and a choice, for mechanism files to import
progress: the lines and the bar of a run while it works
reach: arms and struts that reach a common point, for mechanism files to import
vectors: vectors for closures that are not a chain, for mechanism files to import
work: the work of a derivation and of its measurement, counted in terms and steps, and its bound
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pathlib import Path

    from derive.description.mechanism import Mechanism

# SymPy caches its last thousand results unless told otherwise; a derivation needs more of them again.
os.environ.setdefault("SYMPY_CACHE_SIZE", "None")

__all__ = ["compile_mechanism"]


def compile_mechanism(description: Mechanism | str | Path) -> type[Any]:
    """A class of `softkin` for a description, or for the path of the file that holds one.

    The class has all that the generated ones have: it is made from the same text, and measured by the same witness. Two
    compilations give two classes, whatever their names; `softkin.catalogue()` holds neither. Raises
    `DescriptionError`, `Unsolved` or `Disagreement` with what is wrong and what to do, where the machine cannot be
    derived, and `GenerationError` where an installed `softkin` was written by another version of the compiler.
    """
    from derive.live import compiled  # the compiler is loaded when it is used

    return compiled(description)
