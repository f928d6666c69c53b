"""Every method that stands in the emitted text of a loop is executed, and answers what its Python twin answers."""

from __future__ import annotations

import pytest

from derive.description.mechanism import Mechanism
from tests.text.comparisons import POSELESS
from tests.text.loops.answers import COMPARISONS
from tests.text.loops.machines import LOOPS, loops_of
from tests.text.units import compiled, public_methods

METHODS = [(mechanism, method) for mechanism in LOOPS for method in public_methods(mechanism)]
EVERYWHERE = (
    "AxesToCartesian",
    "CartesianToAxes",
    "AxesToOrientation",
    "IsSingularity",
    "Jacobian",
    "AxesToConfiguration_Offset",
    "CartesianToAxes_Offset",
)
"""Methods that are asked for axis values at which no loop closes as well."""


def test_every_loop_is_here() -> None:
    assert len(LOOPS) == 11


def test_every_method_is_here(mechanism: Mechanism) -> None:
    methods = compiled(mechanism).objects[mechanism.block_name].methods
    assert public_methods(mechanism) == tuple(m.name for m in methods if m.access != "PRIVATE")


@pytest.mark.parametrize(("mechanism", "method"), METHODS, ids=[f"{m.block_name}.{method}" for m, method in METHODS])
def test_a_method_answers_as_in_python(mechanism: Mechanism, method: str) -> None:
    compare = COMPARISONS[method]
    for loop in loops_of(mechanism):
        for sample in loop.regular[: 2 if method in POSELESS else None]:
            compare(loop, sample)
        for sample in loop.any if method in EVERYWHERE else ():
            compare(loop, sample)
