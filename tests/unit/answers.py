"""What a program binds, and whether two programs answer the same."""

import numpy as np
import sympy as sp

from derive.ir.interpret import run
from derive.ir.program import Program
from derive.lowering.passes import DERIVED, NOTHING, applied
from derive.optimize.directions import added, unscaled


def values(program: Program) -> dict[str, sp.Expr]:
    return {let.name.name: let.value for let in program.lets()}


def same(first: Program, second: Program) -> None:
    """Both answer the same, whatever they are given."""
    random = np.random.default_rng(3)
    given = {s.name: random.uniform(-3, 3, 200) for s in {*first.inputs, *second.inputs}}
    (wanted, _), (found, _) = (run(p, {s.name: given[s.name] for s in p.inputs}) for p in (first, second))
    for name, value in wanted.items():
        np.testing.assert_allclose(found[name], value, rtol=1e-12, atol=1e-11)


def plain_directions(program: Program) -> Program:
    """The program in which the angles of axes are computed from plain directions."""
    return unscaled(added(program))


def shorter(program: Program) -> Program:
    """An inverse as it is after its derivation."""
    return applied(DERIVED, program, NOTHING)
