"""Three struts that change their lengths and meet in one point, anchored anywhere."""

from functools import cache

import numpy as np
import pytest
import softkin

from derive import compile_mechanism
from derive.mechanism import Mechanism, Task, X, Y, Z, coordinate, linear, rod

ANCHORS = ((0.0, 300.0, 10.0), (-260.0, -150.0, -20.0), (260.0, -150.0, 400.0))
POINT = (40.0, -30.0, 700.0)


@cache
def struts() -> softkin.Mechanism:
    """A machine whose dimensions are coordinates alone."""
    places = [
        tuple(coordinate(f"anchor_{k}_{c}", f"{c} of anchor {k}", nominal=v) for c, v in zip("xyz", place, strict=True))
        for k, place in enumerate(ANCHORS, 1)
    ]
    axes = tuple(linear(f"S{k}", f"Strut {k}", nominal=600.0) for k in (1, 2, 3))
    rods = tuple(rod(str(k), p, (X, Y, Z), s) for k, (p, s) in enumerate(zip(places, axes, strict=True), 1))
    parameters = tuple(p for place in places for p in place)
    described = Mechanism(name="Struts", parameters=parameters, joints=axes, rods=rods, task=Task("xyz"))
    return compile_mechanism(described)(**{p.name: p.nominal for p in parameters})


@pytest.mark.parametrize("point", [POINT, (0.0, 0.0, 500.0), (-310.0, 250.0, 650.0)])
def test_a_strut_is_as_long_as_its_ends_are_apart(point: tuple[float, float, float]) -> None:
    robot = struts()
    lengths = np.linalg.norm(np.subtract(ANCHORS, point), axis=1)
    assert robot.inverse((point, np.eye(3))) == pytest.approx(lengths, rel=1e-12)
    assert robot.forward(lengths)[0].position == pytest.approx(point, abs=1e-9)
