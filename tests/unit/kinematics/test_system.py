"""A linear system in two parts is solved, whichever unknowns are eliminated."""

import numpy as np
import pytest
import sympy as sp

from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.program import Output
from derive.ir.symbols import real
from derive.kinematics.measured.system import System


@pytest.mark.quick
@pytest.mark.parametrize(
    ("first", "turns"), [(3, (3, 4, 5)), (3, (0, 2, 4)), (3, (1,)), (3, (0, 4)), (2, ()), (1, (1,))]
)
def test_it_is_solved(first: int, turns: tuple[int, ...]) -> None:
    """Random systems, both parts of which are regular. A singular one has numbers, too, and the condition says so."""
    size, generator = first + len(turns), np.random.default_rng(5)
    names = sp.Matrix(size, size + 1, lambda i, j: real(f"entry_{i}_{j}"))
    system = System(names[:, :size], first, turns, (sp.Float(1e-12), sp.Float(1e-12)))
    found = system.solve("right", names[:, size])
    flags = [Output("is_regular", sp.And(*system.conditions))]
    program = normalise("solve", system.lets, [*flags, *(Output(f"x{k}", x) for k, x in enumerate(found))])
    values = generator.uniform(-1.0, 1.0, (50, size, size + 1))
    for row, column in enumerate((*(k for k in range(size) if k not in turns), *turns)):
        values[:, row, column] += 4.0
    values[0, :, turns[0] if turns else 0] = 0.0
    answers, _ = run(program, {str(name): values[:, i, j] for (i, j), name in np.ndenumerate(np.array(names))})
    solved = np.stack([answers[f"x{k}"] for k in range(size)], axis=1)
    assert not answers["is_regular"][0] and answers["is_regular"][1:].all() and np.isfinite(solved).all()
    left = np.einsum("nij,nj->ni", values[1:, :, :size], solved[1:]) - values[1:, :, size]
    assert np.abs(left).max() < 1e-13
