"""Impossible machines: one clear message that names the parameter, and no robot."""

from math import inf, nan

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism, Role
from tests.catalogue.machines import LENGTHS, Machine
from tests.mechanisms import has_struts


def refused(machine: Machine, name: str, **given: object) -> None:
    """A change of parameters is refused, and the message names the mechanism and what is wrong."""
    with pytest.raises(KinematicsError) as error:
        machine.changed(**given)
    message = str(error.value)
    assert error.value.status is Status.NOT_INITIALIZED
    assert machine.mechanism.name in message
    assert name in message
    assert "\n" not in message


def test_every_number_must_be_one(machines: tuple[Machine, ...]) -> None:
    for parameter in machines[1].robot.PARAMETERS:
        for value in (nan, inf, -inf, 1e300, -1e300, "5", None, [5.0], 5j):
            refused(machines[1], parameter.name, **{parameter.name: value})


@pytest.mark.serial
def test_ranges(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    """Just inside is accepted, just outside refused: the ends belong to the range, but no length is zero."""
    machine = machines[0]
    for parameter in mechanism.parameters:
        if parameter.role in (Role.FLAG, Role.SIGN):
            continue
        step = 1e-3 if parameter.role is not Role.LENGTH else 1e-9
        high = min(parameter.high, 1e9)
        machine.changed(**{parameter.name: high})
        refused(machine, parameter.name, **{parameter.name: high + max(step, high * 1e-9)})
        refused(machine, parameter.name, **{parameter.name: parameter.low - step})
        if parameter.low_open:
            refused(machine, parameter.name, **{parameter.name: parameter.low})
            machine.changed(**{parameter.name: parameter.low + step})
        elif parameter.role is Role.SIGNED_LENGTH:
            refused(machine, parameter.name, **{parameter.name: 0.0})
            machine.changed(**{parameter.name: parameter.low})
        else:
            machine.changed(**{parameter.name: parameter.low})


def test_ranges_of_the_vendor_are_no_refusals() -> None:
    """The SF512x manual has links up to 800, pitches up to 200, axes up to 360, 400 and 720: more is possible."""
    limits = {f"lower_{key}": -1000.0 for key in ("a1", "a2", "a3", "a4")}
    limits |= {f"upper_{key}": 1000.0 for key in ("a1", "a2", "a3", "a4")}
    robot = softkin.Scara4ZCcoupledType1(
        link_length_1=900.0, link_length_2=1100.0, pitch_zc=250.0, offset_a1=400.0, offset_a3=-450.0, **limits
    )
    axes = (430.0, 65.0, -500.0, 725.0)
    frame, configuration = robot.forward(axes)
    np.testing.assert_allclose(robot.inverse(frame, configuration, reference=axes), axes, atol=1e-9)
    turn, elbow = np.radians(30.0), np.radians(95.0)
    x = 900.0 * np.cos(turn) + 1100.0 * np.cos(elbow)
    assert frame.position[0] == pytest.approx(x) and frame.position[2] == pytest.approx(-50.0 - 250.0 * 725 / 360)
    for wrong in ({"link_length_1": 0.0}, {"link_length_2": -1.0}, {"pitch_zc": nan}):
        with pytest.raises(KinematicsError, match=next(iter(wrong))):
            softkin.Scara4ZCcoupledType1(**{"link_length_1": 900.0, "link_length_2": 1100.0, **wrong})


def test_lengths_must_be_given_and_nothing_else_need_be(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    robot_class = type(machines[0].robot)
    lengths = {p.name: p.nominal for p in mechanism.parameters if p.default is None}
    assert {p.name for p in mechanism.parameters if p.role is Role.LENGTH} <= set(lengths)
    rails = {p.name: p.nominal for p in mechanism.parameters if p.name.startswith("rail_") and p.default is not None}
    robot = robot_class(**lengths, **rails)  # rails that are not given lie on the origin: one or two may, three may not
    for name in lengths:
        with pytest.raises(TypeError, match=name):
            robot_class(**{k: v for k, v in lengths.items() if k != name})
    with pytest.raises(TypeError, match="'no_such_parameter': the parameters are "):
        robot_class(**lengths, no_such_parameter=1.0)
    with pytest.raises(TypeError, match="'chek_limits': did you mean 'check_limits'"):
        robot_class(**lengths, chek_limits=True)
    with pytest.raises(TypeError, match="'chek_limits': did you mean 'check_limits'"):
        robot.changed(chek_limits=True)
    with pytest.raises(TypeError, match="give each parameter by its name, as "):
        robot_class(325.0, 225.0)


def test_defaults_are_the_ones_it_says(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    robot = machines[0].robot
    for parameter in robot.PARAMETERS:
        expected = machines[0].given.get(parameter.name, parameter.default)
        assert robot.parameters[parameter.name] == expected
        own = next((p for p in mechanism.parameters if p.name == parameter.name), None)
        usual = dict.fromkeys(("check_limits", "check_forward"), 1.0)
        usual |= dict.fromkeys(("min_type2_margin", "warning_distance"), 1e-3)
        swing = 45.0 if parameter.name == "max_angle_ball_joint" else None  # as CODESYS has it
        by_role = {**dict.fromkeys(LENGTHS), Role.ANGLE: swing, Role.SIGN: 1.0}
        one_by_one = mechanism.is_platform or mechanism.drives or has_struts(mechanism)
        if one_by_one and own is not None:  # what must be given, and what need not, is said one by one
            by_role |= dict.fromkeys((Role.DISTANCE, Role.ANGLE), own.default)
        assert parameter.default == (usual.get(parameter.name, 0.0) if own is None else by_role.get(own.role, 0.0))


def test_limits_must_be_in_order(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    names = [j.key for j in mechanism.joints] + [q.name for q in mechanism.limited]
    for name in names:
        lower, upper = f"lower_{name}", f"upper_{name}"
        for low, high in ((10.0, 10.0), (10.0, -10.0), (0.0, -5.0), (5.0, 0.0), (10.0, 10.0 - 1e-9)):
            refused(machines[0], lower, **{lower: low, upper: high})
        machines[0].changed(**{lower: 0.0, upper: 0.0})
        machines[0].changed(**{lower: -5.0, upper: 0.0})
        machines[0].changed(**{lower: 0.0, upper: 5.0})


def test_signs_and_flags(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    kinds = {p.name: p.kind for p in machines[0].robot.PARAMETERS}
    for name, kind in kinds.items():
        good = {"sign": (1, -1, 1.0), "flag": (True, False, 0, 1, 1.0)}.get(kind, ())
        wrong = {"sign": (0, 2, -2, 0.5, 1.0000001), "flag": (2, -1, 0.5, "yes")}.get(kind, ())
        for value in good:
            assert machines[0].changed(**{name: value}).parameters[name] == value
        for value in wrong:
            refused(machines[0], name, **{name: value})


@pytest.mark.serial
def test_a_coupling_is_given_once(machines: tuple[Machine, ...]) -> None:
    """The pitch and the gear coupling of an axis cannot both be given."""
    for machine in machines:
        for constraint in machine.mechanism.constraints:
            names = sorted(s.name for s in constraint.condition.free_symbols)
            assert names == ["gear_coupling", "pitch_zc"]
            machine.changed(pitch_zc=20.0, gear_coupling=0.0)
            machine.changed(pitch_zc=0.0, gear_coupling=0.1)
            refused(machine, "gear_coupling", pitch_zc=20.0, gear_coupling=0.1)
