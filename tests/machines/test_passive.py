"""Chains that move a coordinate which nobody commands: forward kinematics reports it, the inverse does not read it."""

from dataclasses import replace

import numpy as np
import pytest
import softkin

from derive.description.mechanism import DescriptionError, Mechanism, Task, Turning
from derive.description.validate import validate
from derive.frames import Ry, Rz, Tx, Tz
from derive.mechanism import length, rotary
from tests.catalogue.closure import Closure
from tests.machines.both import forward_in_both, in_both, inverse_in_both
from tests.random_axes import random_axes

A1, A2 = (rotary(name, f"turn {name}") for name in ("A1", "A2"))
HEIGHT, L1, L2 = (length(f"link_{k}", f"link {k}", nominal=v) for k, v in enumerate((120.0, 300.0, 250.0)))
CRANK = Mechanism("Crank", (A1,), Task("x", passive="y"), parameters=(L1,), chain=Rz(A1) * Tx(L1))
POLE = Mechanism(
    "PoleArm",
    (A1, A2),
    Task("xz", passive="y"),
    parameters=(HEIGHT, L1, L2),
    chain=Tz(HEIGHT) * Rz(A1) * Tx(L1) * Ry(A2) * Tx(L2),
)
WRONG = {
    "a coordinate that is commanded": replace(CRANK, task=Task("xy", passive="y")),
    "another order": replace(CRANK, task=Task("x", passive="zy")),
    "a direction": replace(POLE, task=Task("x", Turning.DIRECTION, passive="y")),
    "no position": replace(POLE, task=Task("", Turning.FULL, passive="y")),
}


@pytest.mark.slow
@pytest.mark.parametrize("mechanism", [CRANK, POLE], ids=lambda m: m.name)
def test_it_is_reported_and_not_read(mechanism: Mechanism) -> None:
    described = validate(mechanism)
    _, robot, controller = in_both(described, {"offset_a1": 20.0})
    closure = Closure(described, robot.parameters)
    task = ["xyz".index(c) for c in described.task.position]
    for axes in random_axes(robot, 20, np.random.default_rng(1), 80.0).tolist():
        answer = forward_in_both(controller, robot, axes, 1e3)
        assert answer is not None
        frame, place = answer[0], closure.poses(np.array([axes]))[0][0]
        assert frame.position == pytest.approx(place.tolist(), abs=1e-9)
        aside = softkin.Frame((place[0], place[1] + 700.0, place[2]), frame.rotation)
        slots = inverse_in_both(controller, robot, frame, axes)
        assert inverse_in_both(controller, robot, aside, axes) == slots
        assert len(slots) in (2, 4) and any(np.allclose(found, axes, rtol=0.0, atol=1e-6) for found in slots)
        for found in slots:
            assert np.array(robot.forward(found)[0].position)[task] == pytest.approx(place[task], abs=1e-9)


@pytest.mark.parametrize("name", WRONG)
def test_only_what_a_chain_moves_and_nobody_commands_is_passive(name: str) -> None:
    with pytest.raises(DescriptionError, match=r"passive='z?y' must be coordinates that are not commanded"):
        validate(WRONG[name])
