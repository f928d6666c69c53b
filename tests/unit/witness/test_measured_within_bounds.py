"""The measurement of a machine ends within its bound of work, with a refusal that names the stage and what to do."""

from collections.abc import Callable
from math import inf

import pytest

from derive import pipeline
from derive.description.mechanism import Mechanism, Task
from derive.description.remedies import with_remedy
from derive.description.validate import validate
from derive.frames import Rz, Tx
from derive.kinematics.build import build
from derive.solver.unsolved import Exhausted
from derive.work import STEPS, at_most
from tests.unit.kinematics.inventions import A1, A2, L1, L2

ARM = Mechanism(
    name="Arm", parameters=(L1, L2), joints=(A1, A2), chain=Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2), task=Task("xy")
)


def steps(of: Callable[[Mechanism], object]) -> int:
    """Those that it takes."""
    with at_most(inf, unit=STEPS) as work:
        of(validate(ARM))
    return work.done


def test_each_stage_is_refused_by_its_name(monkeypatch: pytest.MonkeyPatch) -> None:
    most, again = (steps(pipeline.derive_and_measure) - steps(build) for _ in (1, 2))
    assert most == again < pipeline._MOST_STEPS / 100
    for bound, stage in (
        (0, "the search for an example of its branches"),
        (most // 4, "the measurement against its equations"),
        (most - 1, "the self-test of the machine"),
    ):
        monkeypatch.setattr(pipeline, "_MOST_STEPS", bound)
        with pytest.raises(Exhausted) as refused:
            pipeline.derive_and_measure(validate(ARM))
        said = with_remedy(str(refused.value))
        assert said.startswith(f"Arm: {stage} was given up after {bound:,} steps; name another joint in search=")
