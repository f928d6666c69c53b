"""A loop that closes at few of the sampled poses: with the pose that its refusal names as nominal values it derives."""

import re
from dataclasses import replace

import numpy as np
import pytest
from sympy import cos, pi, sin

from derive.description.mechanism import DescriptionError, Mechanism, Task, X, Y, Z, length, linear, rod
from derive.description.validate import validate
from derive.pipeline import derive_one
from tests.machines.made import imported_class

RADIUS = length("radius", "distance of the anchors from the centre", nominal=180.0)


def hung(nominal: tuple[float, float, float]) -> Mechanism:
    """A point on three cables, whose lengths are the axes."""
    cables = tuple(linear(f"S{k}", f"cable {k}", nominal=v) for k, v in enumerate(nominal, 1))
    anchors = [(RADIUS * cos(2 * pi * k / 3), RADIUS * sin(2 * pi * k / 3), 0) for k in range(3)]
    return Mechanism(
        name="Kin_HungPoint",
        joints=cables,
        parameters=(RADIUS,),
        rods=tuple(rod(j.key, anchor, (X, Y, Z), j) for j, anchor in zip(cables, anchors, strict=True)),
        task=Task("xyz"),
        positive=cables,
    )


def test_the_pose_that_a_refusal_names_is_one_to_start_from() -> None:
    with pytest.raises(DescriptionError, match="no sampled pose is possible, but the loop closes at S1 = ") as refusal:
        derive_one(validate(hung((0.0, 0.0, 0.0))))
    named = tuple(map(float, re.findall(r"S[123] = ([0-9.]+)", str(refusal.value))))
    mechanism = hung((named[0], named[1], named[2]))
    robot = imported_class(mechanism, derive_one(validate(mechanism)))(radius=180.0)
    frame, configuration = robot.forward(named)
    anchors = [(180.0 * np.cos(2 * np.pi * k / 3), 180.0 * np.sin(2 * np.pi * k / 3), 0.0) for k in range(3)]
    away = [float(np.linalg.norm(np.subtract(frame.position, a))) for a in anchors]
    assert away == pytest.approx(named, abs=1e-9)
    assert abs(frame.position[2]) > 10.0  # not where the anchors and the point are in one plane
    assert robot.inverse(frame, configuration, named) == pytest.approx(named, abs=1e-9)


def test_a_rod_is_named_in_small_letters() -> None:
    """Programs call values of a rod by its name, and Structured Text knows no case."""
    mechanism = hung((200.0, 200.0, 200.0))
    loud = replace(mechanism, rods=(replace(mechanism.rods[0], name="S1"), *mechanism.rods[1:]))
    with pytest.raises(DescriptionError, match="cannot name a rod: lower-case letters and digits"):
        validate(loud)
