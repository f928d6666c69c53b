"""Where steppers stand after G28, behind a line that is refused, and on lines that turn an axis far."""

from __future__ import annotations

import os
import shutil
import sys
from math import degrees, hypot
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from tests.klipper.pretended import EVENTS, STUB, Config, Homing, Refused, loaded, made, move, way

pytestmark = pytest.mark.broad

EQUAL = {"arm_length_1": 300.0, "arm_length_2": 300.0}


def stands(kinematics: Any) -> list[float]:
    """The axes at which the steppers are."""
    return [degrees(one.position) if one.turns else one.position for one in kinematics.get_steppers()]


def go(kinematics: Any, *corners: list[float]) -> None:
    """Lines that are tested and run."""
    for start, end in zip(corners, corners[1:], strict=False):
        kinematics.check_move(move(start, end))
        for one in kinematics.get_steppers():
            one.set_position(end)


def test_a_g28_behind_a_turn_takes_it_back() -> None:
    """Once about the middle the axis is 360 degrees farther; G28 says that it stands at position_home."""
    kinematics, home = made("Kin_Polar"), list(way("Kin_Polar").home)
    start = list(kinematics._home)
    radius = hypot(*start)
    go(kinematics, start, [0.0, radius, 0.0], [-radius, 0.0, 0.0], [0.0, -radius, 0.0], start)
    assert stands(kinematics) == pytest.approx([home[0] + 360.0, home[1]])
    EVENTS.clear()
    kinematics.home(Homing(kinematics))
    assert stands(kinematics) == pytest.approx(home)
    assert EVENTS == ["homing:home_rails_begin", "homing:home_rails_end"]  # these end a G92
    go(kinematics, start, [0.0, radius, 0.0])
    assert stands(kinematics) == pytest.approx([90.0, radius])


def test_a_line_that_something_else_refuses_moves_nothing() -> None:
    """The extruder may refuse a line that was tested, here one by 230 degrees: the next one begins where it did."""
    kinematics = made("Kin_Scara2_Z", **EQUAL)
    start, near = [550.0, 5.0, 0.0], [540.0, 5.0, 0.0]
    go(kinematics, list(kinematics._home), start)
    before = stands(kinematics)
    kinematics.check_move(move(start, [-100.0, 5.0, 0.0]))
    kinematics.check_move(move(start, near))
    kinematics.set_position(near, "")
    assert stands(kinematics) == pytest.approx(before, abs=10.0)


def test_a_line_may_turn_an_axis_by_more_than_half_a_turn() -> None:
    """The first arm of a SCARA with equal arms, on a line that passes its middle closely."""
    kinematics = made("Kin_Scara2_Z", **EQUAL)
    start = [550.0, 5.0, 0.0]
    go(kinematics, list(kinematics._home), start)
    kinematics.check_move(move(start, [-550.0, 5.0, 0.0]))
    first = kinematics.get_steppers()[0]
    values = [degrees(first.along(start, (-1.0, 0.0, 0.0), 10.0, 0.0, time)) for time in np.linspace(0.0, 110.0, 2001)]
    assert np.ptp(values) > 200.0 and np.abs(np.diff(values)).max() < 10.0


@pytest.mark.parametrize(("begin", "end"), [(-0.45, 0.45), (-594.7, 595.3)])
def test_lines_are_tested_every_half_millimetre(begin: float, end: float) -> None:
    """Arms that differ by 0.28 mm leave a hole of 0.56 mm, which no line may cross, a short or a long one."""
    kinematics = made("Kin_Scara2_Z", arm_length_1=300.0, arm_length_2=300.28)
    with pytest.raises(Refused, match="out of reach"):
        kinematics.check_move(move([begin, 0.0, 0.0], [end, 0.0, 0.0]))


def test_a_home_that_is_not_of_the_machine_is_refused() -> None:
    """A branch that is not that of position_home, and a limit that excludes it: the machine stands elsewhere."""
    assert way("Kin_Scara2_Z").home[1] < 0.0
    with pytest.raises(Refused, match="printer: elbow: at position_home it is left"):
        made("Kin_Scara2_Z", elbow="right")
    with pytest.raises(Refused, match="printer: position_home: A1"):
        made("Kin_Scara2_Z", lower_a1=20.0, upper_a1=90.0)


def test_a_position_that_no_stepper_can_have_ends_homing() -> None:
    """SET_KINEMATIC_POSITION to where the machine does not reach: moves are refused until it is homed again."""
    kinematics = made("Kin_Scara2_Z")
    start = list(kinematics._home)
    before = stands(kinematics)
    with pytest.raises(Refused, match="out of reach"):
        kinematics.set_position([3000.0, 0.0, 0.0], "xyz")
    assert stands(kinematics) == before
    with pytest.raises(Refused, match="Must home first"):
        kinematics.check_move(move([3000.0, 0.0, 0.0], start))
    kinematics.home(Homing(kinematics))
    kinematics.check_move(move(start, [start[0] - 1.0, *start[1:]]))


def test_the_end_of_a_line_at_a_limit_is_no_limit_for_a_stepper() -> None:
    """At the end of a line rounding may put the position beyond what was tested."""
    kinematics = made("Kin_Gantry3", lower_x=-100.0, upper_x=100.0)
    start = list(kinematics._home)
    end = [100.0, *start[1:]]
    go(kinematics, start, end)
    x = kinematics.get_steppers()[0]
    assert x.at([100.001, *start[1:]]) == 100.001
    with pytest.raises(Refused, match="X"):
        kinematics.check_move(move(end, [100.001, *start[1:]]))


def test_klipper_with_other_headers_has_the_module_compiled_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The structs of Klipper are compiled in: an update of Klipper may change them."""
    shared: ModuleType = sys.modules[loaded("Kin_Polar").Kinematics.__module__]
    library = Path(shared._FOLDER) / "softkin_polar.so"
    made("Kin_Polar")
    before = library.stat().st_mtime_ns
    shutil.copytree(STUB, tmp_path / "chelper")
    monkeypatch.setattr(shared.chelper, "__file__", str(tmp_path / "chelper" / "__init__.py"))
    shared._loaded("polar", Config({}))
    assert library.stat().st_mtime_ns == before
    os.utime(tmp_path / "chelper" / "trapq.h")
    shared._loaded("polar", Config({}))
    assert library.stat().st_mtime_ns > before
