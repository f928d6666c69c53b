"""Dimensions that cannot form a machine are refused, in Python and by Initialize; just inside, they are not."""

from __future__ import annotations

import pytest
import softkin
from softkin import KinematicsError, Status

ARM = {"inner_arm": 100.0, "outer_arm": 200.0}
UPRIGHT = {"inner_radius": 60.0, "arm_length": 400.0, "rail_angle": 0.0, "max_angle_ball_joint": 45.0}
TYPE_12 = {"link_length_1": 300.0, "link_length_2": 350.0, "link_length_3": 100.0, "link_length_4": 300.0, "link_length_5": 100.0}


EDGES = {
    "P2CType1": (lambda s: {**ARM, "displacement": 340.0 + s, "tcp_displacement": 40.0}, "reach the plate"),
    "P2CType2": (lambda s: {**ARM, "displacement": 340.0 + s, "tcp_link_distance": 80.0}, "reach the plate"),
    "BipodRotary": (lambda s: {**ARM, "displacement": 340.0 + s, "tcp_displacement": 40.0}, "reach the plate"),
    "P2XType1": (lambda s: {"arm_length_1": 200.0, "arm_length_2": 100.0, "rail_y_2": 300.0 + s}, "meet between the rails"),
    "KinType12XY": (lambda s: {**TYPE_12, "link_length_5": 700.0 + s}, "link 5"),
    "TripodLinear": (
        lambda s: {**UPRIGHT, "outer_radius": 460.0 + s},
        "reach the plate",
    ),
}


@pytest.mark.parametrize("name", EDGES)
def test_the_edge_of_what_can_be_assembled(name: str) -> None:
    dimensions, message = EDGES[name]
    make = getattr(softkin, name)
    make(**dimensions(-1e-6))
    with pytest.raises(KinematicsError, match=message) as error:
        make(**dimensions(+1e-6))
    assert error.value.status is Status.NOT_INITIALIZED


def test_steep_rails_can_be_as_far_apart_as_they_like() -> None:
    softkin.TripodLinear(outer_radius=4000.0, inner_radius=60.0, arm_length=400.0, rail_angle=30.0, max_angle_ball_joint=45.0)
