"""The tool: its length by a pin, as LinuxCNC counts it, and the frames of tool and work against the machine."""

from __future__ import annotations

import ctypes
from itertools import islice
from typing import Any

import numpy as np
import pytest
import softkin

from derive.emit.linuxcnc.tool import tool_of
from tests.corpus.dimensions import DIMENSIONS
from tests.linuxcnc.machine import NAMES, Array, about, answered, machine_of, regular
from tests.linuxcnc.module import LETTERS, STUBS, Module
from tests.linuxcnc.test_jacobian import by_letters
from tests.mechanisms import kinematics_of, named

LONGER = 17.5
DOWN = about(0, 180.0)


def _length(name: str) -> str:
    kin = kinematics_of(named(name))
    return tool_of(kin, machine_of(name).words).length


LENGTHS = {
    "Softkin_TableTable_AC": "tool_length", "Softkin_NutatingHead_CB": "pivot_length",
    "Softkin_HeadTable_BC": "pivot_length", "Kin_5Axes": "tool_length", "Kin_ArticulatedRobot_6DOF": "d6",
    "Kin_Ac6_TXTYTZRYRXRZ": "flange_z",
}  # fmt: skip


@pytest.mark.parametrize("name", LENGTHS)
def test_length(name: str) -> None:
    """With the pin, joints are those of a machine with a longer tool, and LinuxCNC's Z is the tip's and the length."""
    assert _length(name) == LENGTHS[name]
    machine, count, own = machine_of(name, STUBS[len(name) % 2]), 0, LENGTHS[name]
    longer = softkin.catalogue()[name](**DIMENSIONS[name] | {own: DIMENSIONS[name].get(own, 0.0) + LONGER})
    for axes, _ in islice(regular(machine, 0.1), 6):
        machine.module.set(tool_offset=LONGER)
        pose = machine.module.forward(axes)
        assert pose is not None
        assert [pose[i] for i in "XYZ"] == pytest.approx(np.add(longer.forward(axes)[0].position, (0, 0, LONGER)))
        found = machine.module.inverse(pose, axes)
        assert found == pytest.approx(axes, abs=1e-7)
        rates = machine.module.jacobian(axes, pose)
        assert rates is not None
        for k, column in by_letters(machine, axes, pose):
            assert np.array(rates)[: len(axes), k] == pytest.approx(column, abs=1e-3), LETTERS[k]
        count += 1
        machine.module.set(tool_offset=0.0)
    assert count >= 3


def test_a_refused_length_changes_nothing() -> None:
    """Neither the machine nor Z."""
    machine = machine_of("Softkin_TableTable_AC")
    before = machine.module.forward([1.0, 2.0, 3.0, 40.0, 50.0])
    machine.module.set(tool_offset=float("inf"))
    assert machine.module.forward([1.0, 2.0, 3.0, 40.0, 50.0]) == before
    assert machine.module.get("softkin.parameters-refused") == 1.0


def test_machines_whose_tool_stays_have_no_pin() -> None:
    """There LinuxCNC's own sum is right."""
    names = [name for name in NAMES if _length(name)]
    assert set(LENGTHS) < set(names) and all(len(named(name).joints) in (5, 6) for name in names)
    assert "softkin.tool-offset" not in machine_of("Kin_Scara4_ZCcoupled_Type1").module.numbers


def _frame(module: Module, which: str, joints: list[float]) -> Array | None:
    columns = (ctypes.c_double * 9)()
    given = (ctypes.c_double * 16)(*joints)
    status = getattr(module.library, f"kinematics{which}Frame")(given, columns, ctypes.byref(ctypes.c_ulong(0)))
    return None if status != 0 else np.array(columns).reshape(3, 3).T


@pytest.mark.parametrize("name", NAMES)
def test_frames(name: str) -> None:
    """The frame of Python, or that turned half a turn about x where z leads away from the holder; the work's too."""
    machine, count = machine_of(name), 0
    kin = kinematics_of(named(name))
    for axes, frame, _ in islice(answered(machine), 12):
        assert machine.module.forward(axes) is not None
        tool, work = (_frame(machine.module, which, axes) for which in ("Tool", "Work"))
        assert tool is not None and work is not None
        seen = work.T @ tool
        own: Any = np.array(frame.rotation)
        assert np.allclose(seen, own, atol=1e-9) or np.allclose(seen, own @ DOWN, atol=1e-9)
        assert np.allclose(tool.T @ tool, np.eye(3), atol=1e-9) and np.linalg.det(tool) > 0.0
        if not any(tool_of(kin, machine.words).on_table):
            assert np.array_equal(work, np.eye(3))
        if machine.words.letters[-1:] == ("Z",) and own[2][2] in (1.0, -1.0):
            assert tool[2][2] == 1.0
        count += 1
    assert count >= 3


@pytest.mark.parametrize(
    ("name", "tool", "work"),
    [
        ("Softkin_TableTable_AC", np.eye(3), about(0, 40.0) @ about(2, 50.0)),
        ("Softkin_HeadTable_BC", about(1, 40.0), about(2, 50.0)),
        ("Softkin_HeadHead_CA", about(2, 40.0) @ about(0, 50.0), np.eye(3)),
    ],
)
def test_five_axes(name: str, tool: Array, work: Array) -> None:
    """What turns the tool turns its frame, what turns the work that of the work; with counts from elsewhere, too."""
    machine = machine_of(name)
    letters = [joint.name for joint in named(name).joints]
    machine.module.set(**{f"offset_{letter.lower()}": 7.0 for letter in letters[3:]})
    axes = [10.0, 20.0, 30.0, 47.0, 57.0]
    found = [_frame(machine.module, which, axes) for which in ("Tool", "Work")]
    assert found[0] is not None and np.allclose(found[0], tool) and found[1] is not None and np.allclose(found[1], work)
    assert machine.module.library.kinematicsSwitch(1) == 0
    assert all(np.array_equal(_frame(machine.module, which, axes), np.eye(3)) for which in ("Tool", "Work"))


def test_a_six_axis_tool_leads_back_to_the_flange() -> None:
    """The frame's z axis points to the work, the tool's to the holder; x is the same."""
    machine = machine_of("Kin_ArticulatedRobot_6DOF")
    axes = [10.0, -80.0, 50.0, 20.0, 60.0, 30.0]
    tool = _frame(machine.module, "Tool", axes)
    own: Any = np.array(machine.robot.forward(axes)[0].rotation)
    assert tool is not None and np.allclose(tool, own @ DOWN)
