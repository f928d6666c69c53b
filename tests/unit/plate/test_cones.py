"""The cones of a rod's joints: valid descriptions, and cones that differ from rod to rod."""

from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from derive.description.mechanism import DescriptionError, Mechanism
from derive.description.validate import validate
from derive.ir.constants import DEGREE
from derive.ir.interpret import run
from derive.ir.program import Status
from derive.ir.symbols import real
from derive.kinematics.build import build
from derive.mechanisms.kin_hexapod import BASE_CONE, MECHANISM, PLATFORM_CONE
from derive.mechanisms.kin_tripod_p3z import MECHANISM as TRIPOD


def with_cones(mechanism: Mechanism, base: list[sp.Expr | None], plate: list[sp.Expr | None]) -> Mechanism:
    rods = (replace(r, base_cone=b, plate_cone=p) for r, b, p in zip(mechanism.rods, base, plate, strict=True))
    return replace(mechanism, rods=tuple(rods))


@pytest.mark.parametrize(
    ("mechanism", "cone", "word"),
    [
        (TRIPOD, sp.Integer(1), "about the rod at the home pose, and the mechanism has none"),
        (MECHANISM, real("width"), "reads 'width', which is not a parameter"),
        (MECHANISM, real("l1"), "reads 'l1', which is not a parameter"),
    ],
)
def test_what_cannot_be_a_cone(mechanism: Mechanism, cone: sp.Expr, word: str) -> None:
    """A cone without a home pose, or with a width that is no parameter, is refused."""
    nothing = [None] * (len(mechanism.rods) - 1)
    for side in (([cone, *nothing], [None, *nothing]), ([None, *nothing], [*nothing, cone])):
        with pytest.raises(DescriptionError, match=word):
            validate(with_cones(mechanism, *side))


@pytest.mark.long
def test_a_rod_without_a_cone_is_free_and_others_have_their_own() -> None:
    """One base joint with one width, one with another; nothing is asked of the others, nor of the platform."""
    wide, narrow = BASE_CONE * DEGREE, PLATFORM_CONE * DEGREE
    kin = build(with_cones(MECHANISM, [None, wide, narrow, None, None, None], [None] * 6))
    names = [s.name for s in kin.branch.inputs]
    assert [n for n in names if "least_cos" in n] == ["least_cos_base_1", "least_cos_base_2"]
    assert [n for n in names if n.startswith("home_along")] == [f"home_along_{rod}_{c}" for rod in "23" for c in "xyz"]
    assert not [n for n in names if n.startswith("plate_axis")]
    for base, plate, status in (
        (90.0, 90.0, Status.OK),
        (1.0, 90.0, Status.UNREACHABLE),
        (90.0, 1.0, Status.UNREACHABLE),
    ):
        given = {p.name: np.asarray(float(p.nominal)) for p in kin.parameters}
        given |= {BASE_CONE.name: np.asarray(base), PLATFORM_CONE.name: np.asarray(plate)}
        constants, _ = run(kin.setup, given)
        pose = {f"r{i}{k}": np.asarray(float(i == k)) for i in (1, 2, 3) for k in (1, 2, 3)}
        pose |= {"x": np.asarray(60.0), "y": np.asarray(0.0), "z": np.asarray(600.0)}
        assert run(kin.branch, {**constants, **pose})[1] == status


def test_the_hexapod_has_them() -> None:
    """The rods of the hexapod have cones at both ends."""
    assert {r.base_cone for r in MECHANISM.rods} == {BASE_CONE * DEGREE}
    assert {r.plate_cone for r in MECHANISM.rods} == {PLATFORM_CONE * DEGREE}
