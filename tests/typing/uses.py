"""Uses of the package, as a strict type checker reads them. `test_uses.py` checks and runs this file."""

from typing import assert_type

import numpy as np
import softkin
from softkin import Frame, KinematicsError, Mechanism, Scara4ZCcoupledType1


def by_name(name: str) -> Mechanism:
    return softkin.catalogue()[name](
        link_length_1=325.0, link_length_2=225.0, limits={"A1": (-170.0, None), "A3": None}
    )


def scara() -> Scara4ZCcoupledType1:
    """A machine by its class, changed, written down and read again."""
    robot = Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, limits={"A1": (-170.0, 170.0)})
    assert_type(robot.link_length_1, float)
    assert_type(robot.check_limits, bool)
    assert_type(robot.changed(pitch_zc=20.0), Scara4ZCcoupledType1)
    assert_type(Scara4ZCcoupledType1.from_dict(robot.to_dict()), Scara4ZCcoupledType1)
    assert_type(Mechanism.from_json(robot.to_json()), Mechanism)
    return robot


def moves(robot: Scara4ZCcoupledType1) -> tuple[float, ...]:
    frame, configuration = robot.forward((10.0, 20.0, 5.0, 30.0))
    assert_type(frame, Frame)
    assert_type(configuration, tuple[int, ...])
    assert_type(robot.nearest(frame, [0, 0, 0, 0], weights=[1, 1, 0, 1], measure="largest"), tuple[float, ...])
    named = robot.configuration(elbow="left", A4=2)
    assert_type(named.names, dict[str, str | int])
    assert_type(robot.inverse(frame, {"elbow": "left", "A4": 2}), tuple[float, ...])
    assert_type(frame @ (1.0, 2.0, 3.0), tuple[float, float, float])
    assert_type(frame @ Frame.from_rpy(10.0, 20.0, 30.0), Frame)
    print(robot.inverse(frame, "left"), (frame @ np.zeros((5, 3))).shape, frame.shifted(z=5.0))
    line = robot.line(frame, ((350.0, 200.0, 5.0), frame.rotation), robot.configuration(), samples=20)
    if line.stop is not None:
        print(line.stop.place, line.stop.refusal.in_words)
    assert_type(line.velocities(2.0), tuple[tuple[float, ...], ...])
    radians = robot.in_radians()
    axes, statuses = robot.nearest_batch([frame.position], [frame.rotation], [0.0, 0.0, 0.0, 0.0])
    assert axes.shape == (1, 4) and statuses[0] == softkin.Status.OK
    true = robot.calibrated({"a2_tilt_x": 0.02})
    assert_type(true.deviations["a2_tilt_x"], float)
    assert_type(true, Mechanism)
    mounted = robot.with_tool(Frame((30.0, 0.0, -60.0))).with_base(frame.matrix)
    assert_type(mounted, softkin.Mounted)
    assert_type(mounted.changed(tool=frame).in_radians(), softkin.Mounted)
    assert_type(mounted.nearest(mounted.forward((10.0, 20.0, 5.0, 30.0))[0], [0, 0, 0, 0]), tuple[float, ...])
    try:
        return radians.inverse(frame, named)
    except KinematicsError as error:
        assert error.refusal is not None
        return (error.refusal.missing,)


if __name__ == "__main__":
    by_name("Kin_Scara4_ZCcoupled_Type1")
    moves(scara())
