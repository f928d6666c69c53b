"""Loops that only turn their platform: in both languages their equations hold, and the commanded rotation is met."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
import softkin
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import ROTATION, DescriptionError, Mechanism, Turning
from derive.description.validate import validate
from derive.pipeline import derive_one
from tests.catalogue.mounted.test_velocities import matrix_of, rows_of
from tests.harness.parse import parse
from tests.harness.unused import unused
from tests.machines.both import forward_in_both, in_both, inverse_in_both
from tests.machines.made import built_of
from tests.machines.spherical_machines import A1, SPHERICAL
from tests.orthonormal import rodrigues
from tests.text.controller import Controller

pytestmark = pytest.mark.slow

EVERY = pytest.mark.parametrize("name", SPHERICAL)
Matrix = NDArray[np.float64]


@cache
def both(name: str) -> tuple[softkin.Mechanism, Controller, Any]:
    """The machine in both languages, with offsets, and its stated equations as a function of joints and rotation."""
    mechanism = validate(SPHERICAL[name])
    offsets = {j.offset.name: 0.3 if j.is_angle else 0.01 for j in mechanism.joints}
    _, robot, controller = in_both(mechanism, offsets)
    known = {p.symbol: p.nominal for p in mechanism.parameters}
    stated = [sp.sympify(e).xreplace(known) for e in mechanism.equations]
    return robot, controller, sp.lambdify([[j.symbol for j in mechanism.joints], list(ROTATION)], stated)


def missed(mechanism: Mechanism, robot: softkin.Mechanism, axes: Any, rotation: Any) -> float:
    equations = both(next(n for n, m in SPHERICAL.items() if m is mechanism))[2]
    joints = [
        (np.radians if j.is_angle else float)(a - robot.parameters[j.offset.name])
        for j, a in zip(mechanism.joints, axes, strict=True)
    ]
    size = max([p.nominal for p in mechanism.parameters], default=1.0)
    return float(np.max(np.abs(equations(joints, list(np.ravel(rotation)))))) / size**2


def near_home(count: int, largest: float) -> list[Matrix]:
    """Rotations about any axis, up to an angle."""
    rng = np.random.default_rng(5)
    found = []
    for _ in range(count):
        axis = rng.normal(size=3)
        found.append(rodrigues(axis / np.linalg.norm(axis), rng.uniform(-largest, largest)))
    return found


@EVERY
def test_the_platform_is_turned_as_commanded(name: str) -> None:
    robot, controller, _ = both(name)
    mechanism = SPHERICAL[name]
    columns = slice(2, 3) if mechanism.task.turning is Turning.DIRECTION else slice(0, 3)
    answered = 0
    for commanded in near_home(40, 0.6):
        rows = tuple(map(tuple, commanded.tolist()))
        asked = softkin.Frame((0.0, 0.0, 0.0), rows)
        for axes in inverse_in_both(controller, robot, asked, [0.0] * len(mechanism.joints), 1e-9):
            there = forward_in_both(controller, robot, axes, 1e-3, 1e-9)
            if there is None:  # a working mode that no home pose has
                continue
            frame = there[0]
            assert frame.position == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
            assert missed(mechanism, robot, axes, frame.rotation) < 1e-11
            if np.allclose(np.array(frame.rotation)[:, columns], commanded[:, columns], rtol=0.0, atol=1e-9):
                answered += 1
    assert answered >= 36


@EVERY
def test_the_jacobian_is_that_of_the_equations(name: str) -> None:
    robot, _, _ = both(name)
    rows = {"turn x", "turn y", "turn z"} if SPHERICAL[name].task.turning is Turning.FULL else {"tilt x", "tilt y"}
    assert set(robot.JACOBIAN_ROWS) == rows
    frame, _ = robot.forward(robot.inverse(((0.0, 0.0, 0.0), tuple(map(tuple, near_home(1, 0.4)[0].tolist()))), None))
    axes = np.array(robot.inverse(frame, None))
    jacobian = matrix_of(robot, axes)
    assert jacobian == pytest.approx(rows_of(robot, axes, 1.0), rel=1e-5, abs=1e-5 * np.abs(jacobian).max())


@EVERY
def test_the_block_uses_what_it_declares(name: str) -> None:
    built = built_of(validate(SPHERICAL[name]))
    blocks = parse(built.parts["st"]["text"], f"{name}.st")
    assert [one for block in blocks for one in unused(block)] == []


@EVERY
def test_on_an_inclined_base_the_platform_moves_as_without_it(name: str) -> None:
    """Velocities and accelerations: turned with the base, or the same about the axes of the tool."""
    robot, _, _ = both(name)
    base = softkin.Frame.from_euler(35.0, 70.0, -15.0, (0.0, 0.0, 0.0))
    frame = ((0.0, 0.0, 0.0), tuple(map(tuple, near_home(1, 0.4)[0].tolist())))
    axes = robot.inverse(frame, None)
    speeds = np.where([j.is_angle for j in SPHERICAL[name].joints], 1.0, 0.1) * (1.0 + np.arange(len(axes)))
    turned = np.array(base.rotation) if SPHERICAL[name].task.turning is Turning.FULL else np.eye(2)
    for call, given in (("twist", (speeds,)), ("twist_rate", (speeds, -2.0 * speeds))):
        bare, mounted = (np.array(getattr(one, call)(axes, *given)) for one in (robot, robot.with_base(base)))
        assert np.abs(bare).min() > 1e-6
        assert mounted == pytest.approx(turned @ bare, rel=1e-9, abs=1e-9 * np.abs(bare).max())


def test_an_equation_that_encloses_no_fixed_angle_is_refused() -> None:
    whole = SPHERICAL["camera on three curved arms"]
    other = (whole.closure[0] + ROTATION[2, 2] * A1.symbol, *whole.closure[1:])
    with pytest.raises(DescriptionError, match="a direction of the platform encloses a fixed angle with one"):
        derive_one(validate(replace(whole, closure=other)))
