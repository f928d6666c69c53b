"""Dimensions that cannot form a machine are refused, in Python and by Initialize; just inside, they are not."""

import numpy as np
import pytest
import softkin
import sympy as sp
from numpy.typing import NDArray
from softkin import KinematicsError, Status

from derive.description.reach import discs_meet
from derive.geometry.vectors import vector
from derive.ir.interpret import evaluate
from tests.catalogue.loops.edges import anchored, arms, around, azimuths, five_bar, links, rails

Array = NDArray[np.float64]
ARM = {"inner_arm": 100.0, "outer_arm": 200.0}
UPRIGHT = {"inner_radius": 60.0, "arm_length": 400.0, "rail_angle": 0.0, "max_angle_ball_joint": 45.0}
TYPE_12 = links(300.0, 350.0, 100.0, 300.0, 100.0)


def delta(radius: float) -> dict[str, float]:
    """A delta with arms of 100 and 200, whose drives are at this radius and whose plate has a radius of 40."""
    sizes = arms(base_radius=radius, inner_arm=100.0, outer_arm=200.0, tcp_radius=40.0)
    return sizes | azimuths(0.0, 120.0, 240.0)


EDGES = {
    "P2CType1": (lambda s: {**ARM, "displacement": 340.0 + s, "tcp_displacement": 40.0}, "reach the plate"),
    "P2CType2": (lambda s: {**ARM, "displacement": 340.0 + s, "tcp_link_distance": 80.0}, "reach the plate"),
    "BipodRotary": (lambda s: {**ARM, "displacement": 340.0 + s, "tcp_displacement": 40.0}, "reach the plate"),
    "P2XType1": (
        lambda s: {"arm_length_1": 200.0, "arm_length_2": 100.0, "rail_y_2": 300.0 + s},
        "meet between the rails",
    ),
    "KinType12XY": (lambda s: {**TYPE_12, "link_length_5": 700.0 + s}, "link 5"),
    "DeltaP3CType3": (lambda s: delta(340.0 + s), "reach the plate"),
    "TripodP3Z": (lambda s: rails(250.0, *around(250.0 + s)), "reach the plate"),
    "TripodLinear": (lambda s: {**UPRIGHT, "outer_radius": 460.0 + s}, "reach the plate"),
}


@pytest.mark.parametrize("name", EDGES)
def test_the_edge_of_what_can_be_assembled(name: str) -> None:
    """Dimensions just inside are accepted, and those just beyond are refused."""
    dimensions, message = EDGES[name]
    make = getattr(softkin, name)
    make(**dimensions(-1e-6))
    with pytest.raises(KinematicsError, match=message) as refused:
        make(**dimensions(+1e-6))
    assert refused.value.status is Status.NOT_INITIALIZED and make.NAME in str(refused.value)


TRIPOD = {"arm_length_1": 200.0, "arm_length_2": 450.0, "arm_1_radius": 140.0, "max_angle_ball_joint": 45.0}
DELTA = arms(base_radius=140.0, inner_arm=200.0, outer_arm=450.0)
CARRIED = {"base_radius": 160.0, "arm_length": 240.0, "rod_length": 560.0, "plate_radius": 45.0}
PLANAR = five_bar(250.0, 500.0, 120.0, 40.0)
TWO_ARMS = {"base_distance": 140.0} | {f"{n}_length_{i}": s for i in "12" for n, s in (("arm", 200.0), ("rod", 260.0))}


RAILS = rails(269.0, (0.0, 150.0), (-130.0, -75.0), (130.0, -75.0))
SMALL = {"tcp_displacement": 20.0}
LINE = rails(269.0, (100.0, 10.0), (200.0, 20.0), (300.0, 30.0))
WIDE = azimuths(0.0, 90.0, -90.0) | arms(base_radius=9000.0)
EVEN = azimuths(120.0, 240.0, 360.0) | arms(base_radius=700.0)
STRUTS = {what: anchored(what)[0][0] for what in ("cable", "strut")}
IMPOSSIBLE = {
    "a plate smaller than its joints": (
        "Kin_Tripod_Rotary",
        TRIPOD,
        {"stewart_radius": 19.99, "distance": 40.0},
        "stewart",
    ),
    "rods that cannot reach": ("Kin_Tripod_Rotary", TRIPOD, {"arm_length_2": 339.99}, "reach"),
    "rods that cannot reach inward": ("Kin_Tripod_Rotary", TRIPOD, {"stewart_radius": 900.0}, "reach"),
    "rails on a line": ("Kin_Tripod_P3Z", {"arm_length": 269.0}, LINE, "line"),
    "rails nowhere": ("Kin_Tripod_P3Z", {"arm_length": 269.0}, {}, "origin"),
    "a plate larger than the rails": ("Kin_Tripod_P3Z", RAILS, {"tcp_displacement": 150.01}, "rail"),
    "a plate larger than rail 2": ("Kin_Tripod_P3Z", RAILS, {**SMALL, "rail_x_2": -9.0, "rail_y_2": -9.0}, "rail 2"),
    "a plate larger than rail 3": ("Kin_Tripod_P3Z", RAILS, {**SMALL, "rail_x_3": 10.0, "rail_y_3": -10.0}, "rail 3"),
    "cables on a line": ("Softkin_ThreeCables", STRUTS["cable"], {"cable_3_y": 0.0}, "line"),
    "struts on a line": ("Softkin_Tripod_Struts", STRUTS["strut"], {"strut_3_y": 0.0}, "line"),
    "arms all the same way": ("Kin_Delta_P3C_Type3", DELTA, arms(azimuth=30.0), "azimuth"),
    "an upper arm too long": ("MC_KIN_TYPE_12_XY", TYPE_12, {"link_length_1": 501.0}, "link 1"),
    "a forearm too long behind": ("MC_KIN_TYPE_12_XY", TYPE_12, {"link_length_3": 701.0}, "link 3"),
    "a rod too long": ("MC_KIN_TYPE_12_XY", TYPE_12, {"link_length_4": 501.0}, "link 4"),
    "a plate too small for the delta": ("Softkin_Delta_C", CARRIED, {"base_radius": 846.0}, "reach the plate"),
    "a plate too small for the bipod": ("Softkin_Bipod_C", PLANAR, {"displacement": 791.0}, "reach the plate"),
    "a dual SCARA too wide": ("Softkin_DualScara", TWO_ARMS, {"base_distance": 921.0}, "span base_distance"),
    "an arm 1 that stays away": ("Softkin_DualScara", TWO_ARMS, {"arm_length_1": 861.0}, "arm 2 must reach"),
    "an arm 2 that stays away": ("Softkin_DualScara", TWO_ARMS, {"rod_length_2": 801.0}, "arm 1 must reach"),
    "two arms the same way": ("Kin_Delta_P3C_Type3", DELTA, azimuths(0.0, 90.0, 90.0), "azimuth"),
    "drives too far apart": ("Kin_Delta_P3C_Type3", DELTA, WIDE, "reach the plate"),
    "arms that meet two and two": ("Kin_Delta_P3C_Type3", DELTA, EVEN, "reach the plate"),
    "rods too short for the rails": ("Kin_Tripod_P3Z", RAILS, {"arm_length": 20.0}, "reach the plate"),
    "rods that meet two and two": ("Kin_Tripod_P3Z", RAILS, {"arm_length": 140.0}, "reach the plate"),
}
POSSIBLE = {
    "a plate as small as its joints": ("Kin_Tripod_Rotary", TRIPOD, {"stewart_radius": 20.0, "distance": 40.0}),
    "rods that just reach": ("Kin_Tripod_Rotary", TRIPOD, {"arm_length_2": 340.01}),
    "a plate almost as large as the rails": ("Kin_Tripod_P3Z", RAILS, {"tcp_displacement": 149.99}),
}


@pytest.mark.parametrize("what", IMPOSSIBLE)
def test_dimensions_that_form_no_machine(what: str) -> None:
    name, given, changes, said = IMPOSSIBLE[what]
    with pytest.raises(KinematicsError, match=said) as refused:
        softkin.catalogue()[name](**given | changes)
    assert refused.value.status is Status.NOT_INITIALIZED and name in str(refused.value)


@pytest.mark.parametrize("what", POSSIBLE)
def test_the_ends_of_what_is_possible(what: str) -> None:
    """Such a machine answers."""
    name, given, changes = POSSIBLE[what]
    robot = softkin.catalogue()[name](**given | changes)
    assert robot.forward_batch(np.random.default_rng(1).uniform(-90.0, 90.0, (200, 3)))[3].min() == Status.OK


def test_steep_rails_can_be_as_far_apart_as_they_like() -> None:
    softkin.TripodLinear(**UPRIGHT | {"outer_radius": 4000.0, "rail_angle": 30.0})


def do_meet(centres: Array, radii: Array) -> NDArray[np.bool_]:
    """Every condition, with numbers for its steps: of centres (n, 3, 2) and radii (n, 3)."""
    names = [vector(*sp.symbols(f"x{i} y{i}", real=True)) for i in range(3)]
    sizes = sp.symbols("r0 r1 r2", nonnegative=True)
    values = {f"r{i}": column for i, column in enumerate(radii.T)}
    values |= {s.name: centres[:, i, k] for i, centre in enumerate(names) for k, s in enumerate(centre)}
    holds = np.ones(len(radii), dtype=bool)
    for constraint in discs_meet(names, sizes, "they meet"):
        for step in constraint.steps:
            values[step.name.name] = evaluate(step.value, values)
        holds &= evaluate(constraint.condition, values).astype(bool)
    return holds


def test_discs_that_meet() -> None:
    """Against the least excess over a grid of points: random discs, and discs of which every two meet around a gap."""
    rng = np.random.default_rng(8)
    grid = np.stack(np.meshgrid(np.linspace(-3, 3, 181), np.linspace(-3, 3, 181)), axis=-1).reshape(-1, 2)
    drawn = [(rng.uniform(-1, 1, (3, 2)), rng.uniform(0.05, 1.5, 3)) for _ in range(60)]
    for turned in rng.uniform(0.0, 2 * np.pi, 10):
        angles = turned + np.radians((0.0, 120.0, 240.0))
        drawn.append((np.stack([np.cos(angles), np.sin(angles)], axis=1), rng.uniform(0.88, 0.95, 3)))
    seen = set()
    for (centres, radii), found in zip(drawn, do_meet(*map(np.array, zip(*drawn, strict=True))), strict=True):
        excess = np.max(np.linalg.norm(grid[:, None] - centres, axis=2) - radii, axis=1).min()
        if abs(excess) < 0.034:
            continue  # too close for the grid
        assert found == (excess < 0), (centres, radii)
        seen.add(bool(found))
    assert seen == {True, False}
