"""Machines of a user's own: letters by what turns them, held joints, gears, tasks with few coordinates, or a pitch."""

from __future__ import annotations

import random
from ctypes import c_double

import numpy as np
import pytest

from derive.description.mechanism import Mechanism
from derive.description.validate import validate
from derive.emit.linuxcnc import package
from derive.emit.linuxcnc.words import Orientation, words_of
from tests.linuxcnc.module import Module, compiled, loaded
from tests.linuxcnc.test_jacobian import by_joints
from tests.machines.collection import MACHINES
from tests.machines.subset_machines import LOOPS, SUBSETS
from tests.machines.task_machines import TASK_MACHINES
from tests.mechanisms import kinematics_of

pytestmark = pytest.mark.slow

EVERY = {**MACHINES, **TASK_MACHINES, **SUBSETS, **LOOPS}
OWN = {
    "trunnion": (Orientation.AXES, "XYZAC"),
    "table with an oblique axis": (Orientation.AXES, "XYZBC"),
    "telescope on a rocker that points the tool": (Orientation.ANGLES, "XYZABC"),
    "seven axes beside each other, the first held": (Orientation.ANGLES, "XYZABCU"),
    "rail and arm with two links": (Orientation.NONE, "XYU"),
    "palletizer with both motors at the base": (Orientation.COUNTED, "XYZC"),
    "SCARA whose quill is geared": (Orientation.COUNTED, "XYZC"),
    "arm with four axes": (Orientation.ANGLES, "XYZABC"),
    "arm in an upright plane": (Orientation.NONE, "XZ"),
    "lift that turns": (Orientation.COUNTED, "ZC"),
    "crank that lifts a slide": (Orientation.NONE, "Z"),
}
"""Machines with what A, B and C are, and all letters."""


def _module(mechanism: Mechanism) -> Module:
    """Its module, with nominal dimensions."""
    kin = kinematics_of(mechanism)
    part = package.part(kin)
    assert part is not None
    module, pins = loaded(compiled(part, "2_9"), len(mechanism.joints)), package.pin_names(kin)
    for p in kin.parameters:
        module.library.stub_set(module.numbers[f"softkin.{pins[p.name]}"], c_double(float(p.nominal)))
    return module


@pytest.mark.parametrize("name", OWN)
def test_a_machine_of_the_user(name: str) -> None:
    """A pose leads back to its joints and to itself, and rates are those of differences."""
    mechanism = validate(EVERY[name])
    words = words_of(kinematics_of(mechanism))
    assert words is not None and (words.orientation, "".join(words.letters)) == OWN[name]
    module, rng = _module(mechanism), random.Random(3)
    compared = 0
    for _ in range(30):
        axes = [rng.uniform(-100.0, 100.0) if j.in_degrees else rng.uniform(50.0, 300.0) for j in mechanism.joints]
        pose = module.forward(axes)
        if pose is None:
            continue
        joints = module.inverse(pose, axes)
        assert joints is not None and module.get("softkin.parameters-refused") == 0.0
        assert joints == pytest.approx(axes, abs=1e-6)
        assert module.forward(joints, pose) == pytest.approx(pose, abs=1e-8)
        compared += 1
        if hasattr(module.library, "kinematicsJacobian") and (rates := module.jacobian(axes, pose)) is not None:
            rows = np.array(rates)[: len(axes)]
            limit = 1e-6 * (1.0 + np.abs(rows).max())
            assert np.allclose(rows @ by_joints(module, axes, pose), np.eye(len(axes)), atol=limit)
    assert compared >= 20
    assert hasattr(module.library, "kinematicsJacobian") == (not mechanism.followed_turns)
