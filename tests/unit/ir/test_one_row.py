"""Programs that run row by row answer as they do on arrays, to the last bit."""

from collections.abc import Mapping

import numpy as np
import pytest
import sympy as sp

from derive.ir import interpret
from derive.ir.interpret import Array, run
from derive.ir.passes import normalise
from derive.ir.program import Iterate, Let, Output, Program, Status
from derive.ir.symbols import real
from derive.report import reference_calls
from derive.report.self_test import self_test
from tests.mechanisms import kinematics_of, named


@pytest.mark.parametrize(
    "name",
    ["Kin_Hexapod", "Softkin_RodWrist", pytest.param("Kin_Ac6_RZRYRYRXRYRZ_J6Offset", marks=pytest.mark.slow)],
)
def test_rows_are_those_of_arrays(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """All programs that a self-test asks, with loops, calls and systems of equations; refused rows have one status."""
    kinematics, statuses = kinematics_of(named(name)), []

    def both(program: Program, values: Mapping[str, Array]) -> tuple[dict[str, Array], Array]:
        found, said = run(program, values)
        with monkeypatch.context() as arrays:
            arrays.setattr(interpret, "_is_run_by_rows", lambda *_: False)
            expected, told = run(program, values)
        assert said.tolist() == told.tolist()
        for output, value in expected.items():
            assert np.array_equal(found[output][said == Status.OK], value[said == Status.OK], equal_nan=True), output
        statuses.extend(said.ravel().tolist())
        return found, said

    monkeypatch.setattr(reference_calls, "run", both)
    self_test(kinematics)
    assert statuses.count(Status.OK) > 10
    assert {*statuses} > {Status.OK}


def test_values_may_be_nested_deeply() -> None:
    """In a statement of a loop, in where it ends, and in an output."""
    x, y, deep = real("x"), real("y"), real("x")
    for _ in range(60):
        deep = sp.sin(deep * y + 1)
    loop = Iterate((x,), (y,), (Let(real("z"), deep),), (real("z"),), sp.Gt(deep, -1), 3, None)
    program = normalise("nested", [loop], [Output("found", real("z") + deep)])
    found, said = run(program, {"y": np.array([1e-3])})
    assert said.tolist() == [Status.OK]
    with_arrays, _ = run(program, {"y": np.full(1000, 1e-3)})
    assert found["found"][0] == with_arrays["found"][0] > 0.0
