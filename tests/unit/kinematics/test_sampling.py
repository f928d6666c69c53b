"""Poses of machines for the decisions of the build: a loop closes at few of the joint values that are drawn."""

import re

import numpy as np
import pytest
from sympy import cos, sin

from derive.description.mechanism import (
    DescriptionError,
    Mechanism,
    Task,
    Vendor,
    X,
    Y,
    angle,
    assembly,
    branch,
    length,
    linear,
    radians,
    rod,
)
from derive.ir.program import Status
from derive.kinematics.build import build
from derive.kinematics.sampling import ENOUGH, sample_axes, sample_machine
from derive.vectors import cross, dot, minus, vector
from tests.unit.kinematics.machine import machine

LEAN_1 = angle("lean_1", "first rail against X", nominal=35.0)
LEAN_2 = angle("lean_2", "second rail against X", nominal=110.0)
S1, S2 = (linear(f"S{k}", f"carriage {k}") for k in (1, 2))
ALONG_1, ALONG_2 = (vector(cos(radians(lean)), sin(radians(lean))) for lean in (LEAN_1, LEAN_2))
PLATE = vector(X, Y)


def rails(rod_length: float, apart: float = 300.0) -> Mechanism:
    """Two rails at any angles, some way apart, whose carriages hold a point by two rods."""
    size = length("rod_length", "both rods", nominal=rod_length)
    carriage_1 = vector(S1 * ALONG_1[0], S1 * ALONG_1[1])
    carriage_2 = vector(apart + S2 * ALONG_2[0], S2 * ALONG_2[1])
    rod_1, rod_2 = minus(PLATE, carriage_1), minus(PLATE, carriage_2)
    return Mechanism(
        name="Kin_Rails",
        vendor=Vendor.TEXTBOOK,
        family="parallel",
        source="the tests",
        summary="Two carriages hold a point.",
        parameters=(LEAN_1, LEAN_2, size),
        joints=(S1, S2),
        rods=(rod("1", carriage_1, PLATE, size), rod("2", carriage_2, PLATE, size)),
        task=Task("xy"),
        branches=(
            branch("left", dot(ALONG_1, rod_1), ahead=+1, behind=-1),
            branch("right", dot(ALONG_2, rod_2), ahead=+1, behind=-1),
        ),
        assembly=assembly("tcp", cross(rod_1, rod_2), margin="aligned", above=+1, below=-1),
    )


@pytest.mark.long
def test_branches_are_told_apart_where_few_of_the_drawn_poses_close() -> None:
    """Rods much shorter than the rails are apart: enough poses are found, and each indicator agrees with one step."""
    mechanism = rails(40.0)
    assert [m.name for m in build(mechanism).margins] == ["left", "right", "aligned"]
    found = machine(mechanism)
    drawn = sample_axes(mechanism, sample_machine(mechanism, 21), 64, 22)
    _, status = found.run(found.kinematics.forward, drawn)
    assert 0 < np.sum(np.asarray(status) == Status.OK) < ENOUGH


@pytest.mark.long
def test_a_loop_that_closes_far_away_is_said_to() -> None:
    """Rails that cross far from where they begin: the sentence names where, by the law of sines."""
    sentence = "no sampled pose is possible, but the loop closes at S1 = 9.728e+05, S2 = 5.938e+05: state nominal"
    with pytest.raises(DescriptionError, match=re.escape(sentence)):
        build(rails(1e-3, 1e6))
