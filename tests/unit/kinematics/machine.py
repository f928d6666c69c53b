"""A built mechanism, driven numerically: every program through `derive.run`, on many poses at once."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from derive.description.mechanism import Mechanism
from derive.ir.interpret import run
from derive.ir.program import Program, Status
from derive.kinematics.kinematics import Kinematics
from tests.mechanisms import kinematics_of

Array = NDArray[np.float64]
Values = dict[str, Array]


@dataclass(frozen=True)
class Machine:
    """The programs of one mechanism and the constants that its setup computed."""

    kinematics: Kinematics
    constants: Values

    @property
    def slots(self) -> tuple[dict[str, float], ...]:
        """Every assignment of the branch signs, slot 0 (all bytes 1) first."""
        names = [f"sigma_{b.name}" for b in self.kinematics.branches]
        found = [dict(zip(names, reversed(signs), strict=True)) for signs in product((1.0, -1.0), repeat=len(names))]
        return tuple(found)

    def run(self, program: Program | None, values: Mapping[str, Array | float]) -> tuple[Values, NDArray[np.object_]]:
        """Outputs and statuses of a program; what the call does not give is one of the machine's constants."""
        assert program is not None
        return run(program, {**self.constants, **values})

    def forward(self, axes: Mapping[str, Array]) -> Values:
        """The pose and the branch margins; every pose must be possible."""
        outputs, status = self.run(self.kinematics.forward, axes)
        assert set(status.flat) == {Status.OK}
        return outputs

    def inverse(
        self, pose: Mapping[str, Array], slot: Mapping[str, float | Array], reference: Mapping[str, Array]
    ) -> tuple[Values, NDArray[np.object_]]:
        values: dict[str, Array | float] = {**pose, **slot}
        for joint in self.kinematics.mechanism.joints:
            values |= {joint.turn.name: 0.0, joint.reference.name: reference[joint.axis.name]}
        return self.run(self.kinematics.branch, values)


def machine(mechanism: Mechanism, **settings: float) -> Machine:
    """Build a mechanism and set it up with its nominal parameters, or with other settings; setup must accept them."""
    kinematics = kinematics_of(mechanism)
    parameters = {p.name: settings.pop(p.name, p.nominal) for p in kinematics.parameters}
    assert not settings, f"no such parameters: {sorted(settings)}"
    outputs, status = run(kinematics.setup, {k: np.asarray(v) for k, v in parameters.items()})
    assert status.item() is Status.OK
    return Machine(kinematics, {k: np.asarray(v) for k, v in outputs.items()})
