"""The generated inverse refuses with its reason, which is what `diagnose` says: there is one inverse."""

import pickle
from collections.abc import Callable

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status

from derive.description.mechanism import Mechanism
from tests.catalogue.references import held_at
from tests.mechanisms import catalogue

MECHANISMS = [m for _, m in catalogue()]
LENGTHS = {"arm_length_1": 300.0, "arm_length_2": 200.0}
NO_TURN = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
UPSIDE_DOWN = ((1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0))


def nominal(mechanism: Mechanism) -> softkin.Mechanism:
    return softkin.catalogue()[mechanism.name](**{p.name: p.nominal for p in mechanism.parameters})


def raised(call: Callable[..., object], *arguments: object) -> KinematicsError | None:
    try:
        call(*arguments)
    except KinematicsError as error:
        return error
    return None


@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda m: m.name)
def test_the_error_has_the_diagnosis(mechanism: Mechanism) -> None:
    """The error of a refused inverse has the diagnosis that `diagnose` returns."""
    robot = nominal(mechanism)
    rng = np.random.default_rng(7)
    size = sum(abs(p.nominal) for p in mechanism.parameters if p.unit == "u") + 100.0
    refused = 0
    for k in range(40):
        frame = tuple(rng.uniform(-size, size, 3).tolist()), NO_TURN if k % 2 else UPSIDE_DOWN
        near = held_at(robot, np.zeros(len(robot.AXES)))
        error, found = raised(robot.inverse, frame, None, near), robot.diagnose(frame, None, near)
        assert (error is None) == (found.status is Status.OK)
        if error is not None:
            refused += 1
            assert error.refusal == found and error.status is found.status
            assert found.reason and str(error).endswith(found.in_words)
            text, _, unit = found.reason.partition(" [")
            amount = f", missing {float(f'{found.missing:.4g}')} {unit.rstrip(']')}".rstrip() if found.missing else ""
            assert found.in_words == f"{text}{amount}" and "[" not in found.in_words
    assert refused or not any("reach" in text or "planar" in text for text in texts_in_the_inverse(robot))


def texts_in_the_inverse(robot: softkin.Mechanism) -> list[str]:
    """The texts in the code of the inverse of one branch: a machine without a bound has none that speaks of one."""
    return [c for c in type(robot)._branch.__code__.co_consts if isinstance(c, str)]


def test_beyond_a_limit_it_says_which_turn_is_inside() -> None:
    """The error of an axis beyond its limit names the turn that is inside, and the missing amount."""
    robot = softkin.Scara2Z(**LENGTHS, lower_a1=-10.0, upper_a1=400.0)
    frame, configuration = robot.forward((-30.0, 40.0, 0.0))
    error = raised(robot.inverse, frame, configuration)
    assert error is not None and error.refusal is not None
    assert error.refusal.turn == 2 and "which is turn 2" in str(error)
    assert error.refusal.missing == pytest.approx(20.0)
    assert error.refusal == robot.diagnose(frame, configuration)


def test_a_point_off_the_flange_is_refused_with_a_reason() -> None:
    """The inverse of a point beside the flange refuses with a reason and an amount."""
    robot = softkin.Scara2Z(**LENGTHS)
    error = raised(robot.inverse_offset, (620.0, 0.0, 0.0), (100.0, 0.0, 0.0))
    assert error is not None and error.refusal is not None
    assert (error.refusal.reason, error.refusal.missing) == ("A2: out of reach [u]", pytest.approx(20.0))


def test_the_rods_of_a_scissor() -> None:
    """The plate cannot be farther from the rails than the rods are long, on either side."""
    robot = nominal(next(m for m in MECHANISMS if m.name == "Kin_P2X_Type2"))
    rod = robot.parameters["arm_length"]
    for height in (rod + 12.5, -rod - 12.5):
        found = robot.diagnose(((0.0, height, 0.0), NO_TURN))
        assert (found.reason, found.missing) == ("rod 1 (through x) cannot reach [u]", pytest.approx(12.5))


def test_a_coupled_pair_names_the_part() -> None:
    """The reason of a coupled pair names the part that refuses."""
    robot = softkin.Coupled(softkin.Scara2Z(**LENGTHS), softkin.CAxis(lower_c=-90.0, upper_c=90.0))
    far = (520.0, 0.0, 0.0), NO_TURN
    error = raised(robot.inverse, far)
    assert error is not None and error.refusal == robot.diagnose(far)
    assert error.refusal is not None and error.refusal.reason == "Kin_Scara2_Z: A2: out of reach [u]"
    assert error.refusal.missing == pytest.approx(20.0)


def test_an_error_travels_whole() -> None:
    """Pickling an error keeps its status, its message and its refusal."""
    error = raised(softkin.Scara2Z(**LENGTHS).inverse, ((600.0, 0.0, 0.0), NO_TURN))
    copy = pickle.loads(pickle.dumps(error))
    assert isinstance(error, softkin.KinematicsError)
    assert (copy.status, str(copy), copy.refusal) == (error.status, str(error), error.refusal)
