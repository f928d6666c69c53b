"""Programs that run row by row answer as they do on arrays, to the last bit."""

from collections.abc import Mapping

import numpy as np
import pytest

from derive.ir import interpret
from derive.ir.interpret import Array, run
from derive.ir.program import Program, Status
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
