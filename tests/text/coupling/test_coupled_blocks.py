"""The emitted blocks, put together as the contract has it, against a coupling in Python.

The stand-in for SoftMotion's coupling calls the documented methods in the documented order and computes nothing but
sums of vectors and products of matrices.
"""

from typing import Any

import numpy as np
import pytest
import softkin
from softkin import KinematicsError

from derive.description.mechanism import Mechanism
from tests.catalogue.coupling.parts import EVERYTHING, ORIENTATIONS, Part, orientation_parts, position_part
from tests.text.controller import OK, Controller, asked
from tests.text.coupling.blocks import Image, OrientationController
from tests.text.samples import tilted
from tests.text.settings import together
from tests.text.units import compiled

CARRIERS = ("Kin_Gantry2", "Kin_Gantry3", "Kin_Scara2_Z", "Kin_Polar_Z", "Kin_Pos_RRR", "Kin_Tripod_Rotary", "Kin_PCC")
POSES = 5


class Coupling:
    def __init__(self, first: Part, second: Part, order: str) -> None:
        self.first = Controller(compiled(first.mechanism, order), first.mechanism)
        self.second = OrientationController(compiled(second.mechanism, order), second.mechanism)
        assert self.first.initialise(first.robot.parameters) == OK
        assert self.second.initialise(second.robot.parameters) == OK
        status, (freedom, zero, base, flange) = self.first.image("GetOrientationImage")
        assert status == OK
        self.image = Image(freedom, zero, base, flange)

    def is_possible(self) -> bool:
        """What leads to SMC_TRAFO_INVALID_COUPLING where it is FALSE."""
        return self.second.is_compatible(self.image)

    def inverse(self, frame: Any, data: tuple[Any, Any], reference: tuple[Any, Any]) -> tuple[str, Any]:
        """Position first, from the end point for the commanded orientation; then the orientation on the flange."""
        position, rotation = frame
        status, shift = self.second.end_point(rotation, self.image, data[1], reference[1])
        if status != OK:
            return status, None
        place = tuple(np.subtract(position, shift).tolist())
        status, axes = self.first.inverse(place, rotation, data[0], reference[0])
        if status != OK:
            return status, None
        status, flange = self.first.orientation(axes)
        assert status == OK
        relative = (np.array(flange).T @ np.array(rotation)).tolist()
        status, own = self.second.inverse((0.0, 0.0, 0.0), relative, data[1], reference[1])
        return (status, (axes, own)) if status == OK else (status, None)

    def forward(self, first: Any, second: Any) -> tuple[Any, Any]:
        """The frame of the second on that of the first."""
        (_, (place, flange, _)), (_, (end, own, _)) = self.first.forward(first), self.second.forward(second)
        return np.array(place) + np.array(flange) @ end, np.array(flange) @ np.array(own)


@pytest.mark.parametrize("order", ("rows", "columns"))
@pytest.mark.parametrize("wrist", ORIENTATIONS, ids=lambda m: m.name)
@pytest.mark.parametrize("carrier", CARRIERS)
def test_blocks_combine_as_in_python(carrier: str, wrist: Mechanism, order: str) -> None:
    """Two blocks that are combined as SoftMotion combines them answer as the coupled mechanism in Python."""
    first = position_part(EVERYTHING[carrier])
    for second in orientation_parts(wrist):
        coupling = Coupling(first, second, order)
        try:
            coupled = softkin.Coupled(first.robot, second.robot)
        except KinematicsError as refusal:
            assert "does not determine" in str(refusal) and not coupling.is_possible()
            continue
        assert coupling.is_possible()
        _agree(coupling, coupled, first, second)


TURNS = (-400.0, -180.0, -20.0, 0.0, 90.0, 200.0)
"""How far the reference of an axis is from a pose."""


@pytest.mark.parametrize("wrist", [m for m in ORIENTATIONS if m.joints], ids=lambda m: m.name)
@pytest.mark.parametrize("carrier", ("Kin_Scara2_Z", "Kin_Pos_RRR", "Kin_PCC"))
def test_drives_of_both_parts_decide_the_turns(carrier: str, wrist: Mechanism) -> None:
    """Each part is handed the limits of its own drives, about its own turn: the answer of two parts
    with these limits.
    """
    first, second = position_part(EVERYTHING[carrier]), orientation_parts(wrist)[0]
    coupling = Coupling(first, second, "rows")
    assert coupling.is_possible()
    rng = np.random.default_rng(53)
    for one, other in zip(first.draw(POSES, rng).tolist(), second.draw(POSES, rng).tolist(), strict=True):
        robots = _around(first, coupling.first, one, rng), _around(second, coupling.second, other, rng)
        coupled = softkin.Coupled(*robots)
        frame, configuration = coupled.forward([*one, *other])
        cut = len(robots[0].CONFIGURATION)
        data = _opened(robots[0], configuration[:cut]), _opened(robots[1], configuration[cut:])
        reference = np.add([*one, *other], rng.choice(TURNS, len(one) + len(other))).tolist()
        expected = coupled.inverse(frame, (*data[0], *data[1]), reference)
        status, found = coupling.inverse(frame, data, (reference[: len(one)], reference[len(one) :]))
        assert status == OK
        assert (*found[0][: len(one)], *found[1][: len(other)]) == pytest.approx(expected, abs=1e-8)
        assert expected == pytest.approx((*one, *other), abs=1e-6)


def _around(part: Part, block: Controller, axes: list[float], rng: np.random.Generator) -> softkin.Mechanism:
    """Drives of less than a turn about axis values: handed over to the block, and as a machine in Python."""
    middles = [value + rng.uniform(-20.0, 20.0) for value in axes]
    drives = [
        (m - 160.0, m + 160.0) if j.is_angle else None for j, m in zip(part.mechanism.joints, middles, strict=True)
    ]
    assert [block.axis_settings(axis, drive) for axis, drive in enumerate(drives)] == [OK] * len(axes)
    both = together(part.mechanism, part.robot.parameters, drives)
    assert both is not None
    return type(part.robot)(**both)


def _opened(robot: softkin.Mechanism, data: Any) -> tuple[int, ...]:
    return (*data[: robot.BRANCHES], *(0,) * len(robot.PERIOD_AXES))


@pytest.mark.parametrize(("name", "freedom"), [("Kin_5Axes", "one"), ("Kin_ArticulatedRobot_6DOF", "zero")])
def test_a_complete_kinematics_states_what_it_leaves_open(name: str, freedom: str) -> None:
    """All orientations; of a programmed one the direction of the tool with any twist, or exactly that."""
    whole = position_part(EVERYTHING[name])
    block = Controller(compiled(whole.mechanism), whole.mechanism)
    rotation = tilted(np.random.default_rng(61))
    assert block.image_with_orientation(rotation)[0] == "SMC_TRAFO_NOT_INITIALIZED"
    assert block.initialise(whole.robot.parameters) == OK
    assert block.image("GetFlangeOrientationImageTotal")[1][0] == "three"
    direction = tuple(row[2] for row in rotation)
    assert block.image_with_orientation(rotation) == (OK, (freedom, rotation, direction, (0.0, 0.0, 1.0)))
    skewed = ((1.0, 0.01, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    assert block.image_with_orientation(skewed)[0] == "SMC_CP_ERROR_CREATING_PARAM_TRANSFORM"


def _agree(coupling: Coupling, coupled: softkin.Coupled, first: Part, second: Part) -> None:
    rng = np.random.default_rng(47)
    cut, bytes_ = len(first.robot.AXES), len(first.robot.CONFIGURATION)
    for one, other in zip(first.draw(POSES, rng).tolist(), second.draw(POSES, rng).tolist(), strict=True):
        frame, configuration = coupled.forward([*one, *other])
        position, rotation = coupling.forward(one, other)
        assert np.abs(position - frame.position).max() < 1e-9 and np.abs(rotation - frame.rotation).max() < 1e-12
        free = softkin.Frame(frame.position, tilted(rng))
        far = softkin.Frame(tuple(20.0 * v + 1e4 for v in frame.position), frame.rotation)
        slots = [s.configuration for s in coupled.inverse_all(frame, [*one, *other])]
        for command in (frame, free, far):
            for data in (configuration, *slots):
                status, answer = asked(coupled.inverse, command, data, [*one, *other])
                found = coupling.inverse(command, (data[:bytes_], data[bytes_:]), (one, other))
                assert found[0] == status
                if answer is not None:
                    axes = (*found[1][0][:cut], *found[1][1][: len(other)])
                    assert axes == pytest.approx(answer, abs=1e-8)
