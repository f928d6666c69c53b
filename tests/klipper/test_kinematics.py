"""Every machine that Klipper can have answers its solver as Python does, and refuses what it cannot reach."""

from __future__ import annotations

from math import degrees
from pathlib import Path

import numpy as np
import pytest

from derive.command.line import main
from derive.description.catalogue import MECHANISMS
from derive.description.validate import validate
from derive.emit.around_c.package import klipper, only_positions
from tests.klipper.pretended import (
    TOOLHEAD,
    Config,
    Homing,
    Refused,
    imported,
    loaded,
    made,
    move,
    sections_of,
    solver,
    way,
)
from tests.machines.surplus_machines import POINTS as SURPLUS
from tests.mechanisms import catalogue, kinematics_of, named

pytestmark = pytest.mark.broad

NAMES = [m.name for _, m in catalogue() if only_positions(m)]
POINTS = 60


@pytest.mark.parametrize("name", NAMES)
def test_steppers_stand_where_python_says(name: str) -> None:
    """Along lines and arcs, in the units of the steppers; the position at these values is the one that was asked."""
    kinematics, one = made(name), way(name)
    axes = one.parts[0].axes
    rows = axes[:: len(axes) // POINTS]
    points = np.array(one.robot.forward_batch(rows)[0])
    steppers = kinematics.get_steppers()
    turns = [axis.unit == "deg" for axis in one.robot.AXES]
    assert [s.turns for s in steppers] == turns and {s.queue for s in steppers} == {"queue"}
    letters = sum(1 << "xyz".index(letter) for letter in named(name).task.position)
    assert {solver().flags(s.solver) for s in steppers} == {letters}
    for before, point, row in zip(points, points[1:], rows[1:], strict=False):
        # A line from the point before, in 2 s with the acceleration 1: at its end the machine is at the point.
        length = float(np.linalg.norm(point - before))
        direction = (point - before) / (length or 1.0)
        found = [s.along(before, direction, length / 2.0 - 1.0, 0.5, 2.0) for s in steppers]
        values = [degrees(v) if is_turn else v for v, is_turn in zip(found, turns, strict=True)]
        assert values == pytest.approx(row, abs=1e-7)
        position = kinematics.calc_position({s.get_name(): v for s, v in zip(steppers, found, strict=True)})
        assert position == pytest.approx(point, abs=1e-7)


def test_a_winch_more_than_hold_the_point_has_a_stepper_of_its_own() -> None:
    mechanism, anchors, middle = SURPLUS["four lines"]
    lengths = np.linalg.norm(np.subtract(anchors, middle), axis=1)
    sizes = {p.name: p.nominal for p in mechanism.parameters}
    homes = {f"stepper_l{k}": {"position_home": v} for k, v in enumerate(lengths, 1)}
    module = imported(kinematics_of(validate(mechanism)))
    kinematics = module.load_kinematics(TOOLHEAD, Config({"printer": sizes, **homes}))
    kinematics.home(Homing(kinematics))
    steppers, place = kinematics.get_steppers(), np.add(middle, (20.0, -30.0, 40.0))
    assert kinematics._home == pytest.approx(middle)
    assert {solver().flags(s.solver) for s in steppers} == {7}
    found = [s.at(place.tolist()) for s in steppers]
    assert found == pytest.approx(np.linalg.norm(np.subtract(anchors, place), axis=1).tolist())
    position = kinematics.calc_position({s.get_name(): v for s, v in zip(steppers, found, strict=True)})
    assert position == pytest.approx(place.tolist(), abs=1e-7)
    longer = {**homes, "stepper_l1": {"position_home": lengths[0] + 10.0}}
    with pytest.raises(Refused, match="it misses the pose that the other axes give"):
        module.load_kinematics(TOOLHEAD, Config({"printer": sizes, **longer}))


@pytest.mark.parametrize("name", ["Kin_Scara2_Z", "Kin_P2C_Type1", "Kin_Delta_P3C_Type3"])
def test_lines_are_checked(name: str) -> None:
    """Not before homing; within reach; and not beyond it, with the reason; nor beyond the range of the printer."""
    kinematics = made(name)
    start = list(kinematics._home)
    near, far = [start[0] - 3.0, *start[1:]], [start[0] + 3000.0, *start[1:]]
    kinematics.check_move(move(start, near))
    with pytest.raises(Refused, match="reach"):
        kinematics.check_move(move(near, far))
    kinematics.clear_homing_state("x")
    assert kinematics.get_status(0.0)["homed_axes"] == ""
    with pytest.raises(Refused, match="Must home first"):
        kinematics.check_move(move(start, near))
    narrow = made(name, axis_minimum=[start[0] - 1.0, -1e4, -1e4])
    with pytest.raises(Refused, match="Move out of range"):
        narrow.check_move(move(start, near))


def test_a_line_through_what_is_out_of_reach_is_refused() -> None:
    """A SCARA whose arms are unequal does not reach its middle."""
    kinematics = made("Kin_Scara2_Z")
    height = kinematics._home[2]
    with pytest.raises(Refused, match="out of reach"):
        kinematics.check_move(move([-200.0, 1.0, height], [200.0, 1.0, height]))


def test_a_plane_has_a_stepper_for_z() -> None:
    """A letter that a machine does not have is a plain stepper if there is a section for it; else it stays."""
    sections = sections_of(way("Kin_Polar"))
    alone = made("Kin_Polar")
    start = list(alone._home)
    with pytest.raises(Refused, match="does not move in Z"):
        alone.check_move(move(start, [*start[:2], start[2] + 1.0]))
    both = loaded("Kin_Polar").load_kinematics(TOOLHEAD, Config({**sections, "stepper_z": {"position_home": 3.0}}))
    both.home(Homing(both))
    assert both.get_steppers()[2].position == 3.0 and both._home[2] == 3.0
    *own, z = both.get_steppers()
    assert len(own) == 2 and z.plain == ("cartesian_stepper_alloc", (b"z",))
    found = {s.get_name(): s.at([100.0, 0.0, 7.0]) for s in own} | {"stepper_z": 7.0}
    assert both.calc_position(found) == pytest.approx([100.0, 0.0, 7.0])


def test_parameters_are_refused_in_words() -> None:
    """A length that is missing, and one that is not allowed."""
    sections = sections_of(way("Kin_Scara2_Z"))
    given = dict(sections["printer"])
    with pytest.raises(Refused, match="printer: .*arm_length_1"):
        made("Kin_Scara2_Z", arm_length_1=-1.0)
    del given["arm_length_1"]
    with pytest.raises(Refused, match="option arm_length_1 must be given"):
        loaded("Kin_Scara2_Z").load_kinematics(TOOLHEAD, Config({**sections, "printer": given}))


def test_machines_that_turn_their_tool_have_no_module() -> None:
    """A SCARA with a fourth axis commands a turn, which a program of a printer does not have."""
    assert klipper.part(kinematics_of(named("Kin_Scara4_ZCcoupled_Type1"))) is None
    assert {"Kin_Scara2_Z", "Kin_Polar_Z", "Kin_P2C_Type1", "Kin_Delta_P3C_Type3", "Kin_Tripod_Linear"} <= set(NAMES)


def test_what_is_left_out_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A sentence for each controller that does not take a machine, and no file."""
    asked = ["derive", str(MECHANISMS / "kin_caxis.py"), "--out", str(tmp_path / "out")]
    assert main([*asked, "--language", "klipper", "--language", "br"]) == 0
    said = capsys.readouterr().out
    assert "no module for Klipper: it takes machines whose position alone decides all 1 axes" in said
    assert "no functions for B&R: its 1 axes are not those of a position" in said
    assert not list((tmp_path / "out").rglob("*.*"))
