"""Whatever the dimensions are, every call ends in an answer or in a `KinematicsError`, never in a division by zero."""

import contextlib

import pytest
import softkin
from softkin import KinematicsError

from derive.description.mechanism import Mechanism
from tests.catalogue.extreme import extreme_dimensions

MACHINES = 8


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_every_call_ends(mechanism: Mechanism) -> None:
    """Numbers that overflow are refused like others that are none."""
    made = softkin.catalogue()[mechanism.name]
    accepted = 0
    for given in extreme_dimensions(mechanism, MACHINES):
        given = {p.name: given[p.name] for p in made.PARAMETERS if p.name in given}
        with contextlib.suppress(KinematicsError):
            robot = made(**given)
            accepted += 1
            axes = [10.0 * (k + 1) for k in range(len(made.AXES))]
            frame = softkin.Frame.from_euler(20.0, 0.0, 0.0, (30.0, -20.0, 10.0))
            for call in (robot.forward, robot.jacobian, robot.singularity):
                with contextlib.suppress(KinematicsError):
                    call(axes)
            with contextlib.suppress(KinematicsError):
                frame, _ = robot.forward(axes)
            with contextlib.suppress(KinematicsError):
                robot.inverse(frame, robot.DEFAULT_CONFIGURATION, axes)
            with contextlib.suppress(KinematicsError):
                tuple(robot.inverse_all(frame, axes))
    assert accepted >= 2


def test_the_least_length_is_refused_and_the_next_is_not() -> None:
    """The bound is one number, and belongs to what is refused."""
    made = softkin.catalogue()["Kin_Scara2_Z"]
    for length in (1e-12, 1e-200, 5e-324):
        with pytest.raises(KinematicsError, match="more than 1e-12"):
            made(arm_length_1=length, arm_length_2=length)
    assert made(arm_length_1=1.1e-12, arm_length_2=1.1e-12).parameters["arm_length_1"] == 1.1e-12
