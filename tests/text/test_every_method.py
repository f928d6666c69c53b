"""Every method of every emitted block is executed, and answers what its Python twin answers."""

from __future__ import annotations

import pytest

from derive.description.mechanism import Mechanism
from tests.text.comparisons import COMPARISONS, POSELESS
from tests.text.twins import MECHANISMS, twins_of
from tests.text.units import compiled, public_methods

METHODS = [(mechanism, method) for mechanism in MECHANISMS for method in public_methods(mechanism)]
"""Every method that stands in the emitted text. That private ones run is shown statement by statement elsewhere."""


def test_every_method_is_here(mechanism: Mechanism) -> None:
    methods = compiled(mechanism).objects[mechanism.block_name].methods
    assert public_methods(mechanism) == tuple(m.name for m in methods if m.access != "PRIVATE")


@pytest.mark.parametrize(("mechanism", "method"), METHODS, ids=[f"{m.block_name}.{method}" for m, method in METHODS])
def test_a_method_answers_as_in_python(mechanism: Mechanism, method: str) -> None:
    compare = COMPARISONS[method]
    for twins in twins_of(mechanism):
        for sample in twins.regular[: 3 if method in POSELESS else None]:
            compare(twins, sample)
