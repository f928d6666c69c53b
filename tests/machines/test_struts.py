"""Struts and cables that change their lengths and meet in a point; a start from the pose that a refusal names."""

import re
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import softkin
from sympy import cos, pi, sin

from derive import compile_mechanism
from derive.description.mechanism import DescriptionError, length
from derive.description.validate import validate
from derive.mechanism import Mechanism, Task, X, Y, Z, coordinate, linear, rod
from derive.pipeline import derive_one
from tests.machines.made import imported_class

ANCHORS = ((0.0, 300.0, 10.0), (-260.0, -150.0, -20.0), (260.0, -150.0, 400.0))
CORNERS = ((0.0, 110.0, 0.0), (-95.0, -55.0, 12.0), (95.0, -55.0, -30.0))
POINT = (40.0, -30.0, 700.0)


@cache
def struts() -> softkin.Mechanism:
    """A machine whose dimensions are coordinates alone: a 3-UPU, whose plate does not turn if the axes of the universal
    joints at both ends of each strut are parallel.
    """
    bases, corners = (
        [
            tuple(coordinate(f"{word}_{k}_{c}", f"{c} of {word} {k}", nominal=v) for c, v in zip("xyz", p, strict=True))
            for k, p in enumerate(places, 1)
        ]
        for word, places in (("anchor", ANCHORS), ("corner", CORNERS))
    )
    axes = tuple(linear(f"S{k}", f"Strut {k}", nominal=600.0) for k in (1, 2, 3))
    plates = [(X + x, Y + y, Z + z) for x, y, z in corners]
    rods = tuple(rod(str(k), b, p, s) for k, (b, p, s) in enumerate(zip(bases, plates, axes, strict=True), 1))
    parameters = tuple(p for place in (*bases, *corners) for p in place)
    described = Mechanism(name="Struts", parameters=parameters, joints=axes, rods=rods, task=Task("xyz"))
    return compile_mechanism(described)(**{p.name: p.nominal for p in parameters})


@pytest.mark.parametrize("point", [POINT, (0.0, 0.0, 500.0), (-310.0, 250.0, 650.0)])
def test_a_strut_is_as_long_as_its_ends_are_apart(point: tuple[float, float, float]) -> None:
    robot = struts()
    lengths = np.linalg.norm(np.add(CORNERS, point) - ANCHORS, axis=1)
    assert robot.inverse((point, np.eye(3))) == pytest.approx(lengths, rel=1e-12)
    assert robot.forward(lengths)[0].position == pytest.approx(point, abs=1e-9)


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
