"""Invented mechanisms from the description to the numbers, through `derive.build` alone."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from derive.description.validate import validate
from derive.ir.program import Let, Output, Program
from derive.witness import witness
from tests.unit.kinematics.inventions import INVENTIONS
from tests.unit.kinematics.machine import Machine, Values, machine

pytestmark = pytest.mark.slow

COUNT = 120
EVERY = pytest.mark.parametrize("name", INVENTIONS)


@cache
def built(name: str) -> Machine:
    """The machine with offsets on its axes: nothing stands at zero by accident."""
    mechanism = validate(INVENTIONS[name].mechanism)
    offsets = {j.offset.name: 10.0 * k - 25.0 for k, j in enumerate(mechanism.joints)}
    return machine(mechanism, **offsets)


def axes_of(name: str) -> Values:
    """Axis values over several turns and along the slides; radii on the side that the machine has."""
    generator = np.random.default_rng(3)
    found: Values = {}
    for joint in built(name).kinematics.mechanism.joints:
        low, high = (-500.0, 500.0) if joint.is_angle else (5.0, 400.0)
        found[joint.axis.name] = generator.uniform(low, high, COUNT) + built(name).constants[joint.offset.name]
    return found


def by_hand(name: str, axes: Values) -> dict[str, np.ndarray]:
    """x, y, z and turn at axis values, by the formulas of the invention."""
    constants, joints, motors = built(name).constants, {}, {}
    for joint in built(name).kinematics.mechanism.joints:
        motors[joint.name] = (axes[joint.axis.name] - constants[joint.offset.name]) * (
            np.pi / 180 if joint.is_angle else 1.0
        )
        joints[joint.name] = motors[joint.name]
    if "coupling_12" in constants:
        joints["A2"] = joints["A2"] + constants["coupling_12"] * motors["A1"]
    plane, z, turn = INVENTIONS[name].hand(constants, joints)
    return {
        k: np.broadcast_to(v, (COUNT,)) for k, v in {"x": plane.real, "y": plane.imag, "z": z, "turn": turn}.items()
    }


@EVERY
def test_forward_is_what_the_description_means(name: str) -> None:
    """Forward kinematics is that of the closure, computed by hand."""
    axes = axes_of(name)
    pose, expected = built(name).forward(axes), by_hand(name, axes)
    size = 1 + max(np.abs(expected[c]).max() for c in "xyz")
    for coordinate in "xyz":
        assert np.abs(pose[coordinate] - expected[coordinate]).max() <= 1e-12 * size
    if "turn z" in built(name).kinematics.rows:
        assert np.abs(pose["r11"] - np.cos(expected["turn"])).max() <= 1e-11
        assert np.abs(pose["r21"] - np.sin(expected["turn"])).max() <= 1e-11


@EVERY
def test_the_witness_finds_no_other_solution(name: str) -> None:
    """Multi-start root finding finds exactly as many solutions as there are slots."""
    evidence = witness(built(name).kinematics, INVENTIONS[name].mechanism)
    assert evidence.inverted is not None
    assert evidence.inverted.solutions == len(built(name).slots)


INPUTS = (0.0, 1e-300, -1e-12, 1e-6, 1.0, -300.0, 500.0, 1e6, 1e9, -1e9)


def everything(program: Program) -> Program:
    """The program with every value that it binds as an output."""
    return replace(program, outputs=tuple(Output(s.name.name, s.name) for s in program.body if isinstance(s, Let)))


@EVERY
@pytest.mark.parametrize(
    "kind", ["forward", "branch", "singularity", "jacobian", "offset_branch", "offset_configuration"]
)
def test_total(name: str, kind: str) -> None:
    """No input gives NaN or infinity, whatever the status: nothing that would stop a controller."""
    program = getattr(built(name).kinematics, kind)
    if program is None:
        assert kind.startswith("offset") and not INVENTIONS[name].mechanism.offers_points
        return
    generator = np.random.default_rng(9)
    free = [s.name for s in program.inputs if s.name not in built(name).constants]
    given = {n: generator.choice(INPUTS, 3000) for n in free}
    given |= {n: generator.choice([-1.0, 1.0], 3000) for n in free if n.startswith("sigma_")}
    values, _ = built(name).run(everything(program), given)
    for let, value in values.items():
        assert np.all(np.isfinite(value)), let
