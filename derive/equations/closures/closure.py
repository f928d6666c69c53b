"""The closure equations of a mechanism as data, in the coordinates of its task."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import sympy as sp

from derive.algebra.normal_form import polynomial
from derive.description.mechanism import Mechanism
from derive.equations.chain_splits import Target
from derive.equations.closures.fixed_names import all_angles, signs_of, with_fixed_names
from derive.equations.problem import Equation
from derive.geometry.frames import Factor
from derive.ir.program import Let
from derive.ir.symbols import COORDINATE_NAMES, real

FLANGE = tuple(real(f"flange_{c}") for c in COORDINATE_NAMES)
"""The position of the flange for a commanded point off it, where the flange keeps its orientation."""


@dataclass(frozen=True)
class Closure:
    """Equations, with the statements that bind their names, in the coordinates of the task."""

    equations: tuple[Equation, ...]
    arguments: tuple[sp.Expr, ...]
    """Arguments of sines and cosines, where sums of parallel angles can be read."""
    lets: tuple[Let, ...] = ()
    planes: tuple[tuple[str, sp.Expr], ...] = ()
    """The coordinates that the task does not command, each with its constant value: z of a machine in a plane."""
    turns: tuple[Factor, ...] = ()
    """The rotations whose product is the commanded one, where the task is more than a rotation about z."""
    columns: tuple[int, ...] = (0, 1, 2)
    """The columns of the commanded rotation that are followed."""
    links: tuple[Factor, ...] = ()
    """The chain for which the position equations are written, which ends in `target`."""
    target: Target = Target(())
    back: tuple[tuple[Factor, ...], Target] | None = None
    """The chain and target of the position equations seen from the flange, to the point in which the first joints
    intersect."""


def arguments_of(expressions: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
    """The arguments of all sines and cosines."""
    found = sp.Matrix(list(expressions)).atoms(sp.sin, sp.cos)
    return tuple(sorted({f.args[0] for f in found}, key=sp.default_sort_key))


def named_equation(mechanism: Mechanism, label: str, expression: sp.Expr) -> Equation:
    """An equation in normal form, with names for the sines, cosines and roots that never change."""
    return Equation(
        label, polynomial(with_fixed_names(mechanism, expression), all_angles(mechanism), signs_of(mechanism))
    )
