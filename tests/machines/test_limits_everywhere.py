"""Just inside and just beyond each limit, everything that speaks of a machine says the same.

Python, JavaScript, the page, a controller that moves it, C, the block, and the machine of the report are asked for the
same poses of a machine of the catalogue, whose limits are given, of a machine whose description states them, and of an
imported one. Whoever takes another value for a limit that nobody gives answers for another machine.
"""

import json
from functools import cache
from typing import Any

import numpy as np
import pytest
import softkin

from derive.controller.machine import machine_of
from derive.drawing.pose import drawn_pose, is_inside, nominal_machine
from derive.emit.page.pictures import maps, pictured
from derive.emit.softmotion.inputs import inputs
from derive.report.derived import derived_of
from derive.report.reference_calls import are_inside
from derive.report.singular_poses import singular_pose
from derive.report.workspace_map import slices
from tests.c.machine import ask as ask_c
from tests.c.programs import compiled
from tests.javascript.modules import written
from tests.javascript.node import ask as ask_javascript
from tests.javascript.node import run
from tests.machines.limited_machines import GIVEN, IMPORTED, OWN, Limited, limited_machine
from tests.text.controller import OK, Controller
from tests.text.units import compiled_text
from tests.view.pages import page_module

pytestmark = pytest.mark.slow

KINDS = pytest.mark.parametrize("kind", (GIVEN, OWN, IMPORTED))
STATED = pytest.mark.parametrize("kind", (OWN, IMPORTED))


@cache
def _asked(kind: str) -> tuple[list[str], list[dict[str, Any]], list[list[Any]]]:
    """The axis that each pose is refused for; the poses for the page; the calls for JavaScript and C."""
    machine = limited_machine(kind)
    expected, poses, calls = [], [], []
    for axes, said in machine.poses():
        frame, configuration = machine.robot.forward(axes)
        given = {"position": list(frame.position), "rotation": [list(row) for row in frame.rotation]}
        branches = machine.mechanism.branches
        bytes_ = [*configuration[: len(branches)], *(0 for _ in configuration[len(branches) :])]
        expected.append(said)
        poses.append({"axes": list(axes), "frame": given, "bytes": bytes_})
        calls.append(["inverse", given, bytes_, list(axes)])
    return expected, poses, calls


def _refused(answer: dict[str, Any]) -> str:
    return _axis(answer["reason"]) if answer["status"] else ""


def _axis(reason: str | None) -> str:
    """The axis of a reason: "A1: above its upper limit", or "A4: this turn is beyond a limit, name one inside"."""
    return (reason or "").partition(":")[0]


@KINDS
def test_python_c_and_javascript(kind: str) -> None:
    machine, (expected, poses, calls) = limited_machine(kind), _asked(kind)
    robot = machine.robot
    told = [robot.diagnose((p["frame"]["position"], p["frame"]["rotation"]), p["bytes"], p["axes"]) for p in poses]
    assert [_axis(why.reason) for why in told] == expected
    question = [{"parameters": dict(machine.given), "calls": calls}]
    module = written(machine.parts["javascript"])
    assert [_refused(found) for found in ask_javascript(module, question)["answers"][0]["found"]] == expected
    assert [_refused(found) for found in ask_c(compiled(machine.parts["c"]), question)[0]["found"]] == expected


@KINDS
def test_the_block(kind: str) -> None:
    machine, (expected, poses, _) = limited_machine(kind), _asked(kind)
    text = machine.parts["st"]["text"]
    names = inputs(machine.kinematics).names
    block = Controller(compiled_text(f"{machine.mechanism.name}.st", text), machine.mechanism, names)
    assert block.initialise(machine.given) == OK
    for said, pose in zip(expected, poses, strict=True):
        asked = pose["frame"]["position"], pose["frame"]["rotation"], pose["bytes"], pose["axes"]
        assert (block.inverse(*asked)[0] == OK) == (said == "")
        assert _axis(block.diagnose(*asked)[0]) == said


@cache
def _page(kind: str) -> Any:
    return page_module(limited_machine(kind).parts["javascript"])


def _told(kind: str, function: str, **question: Any) -> Any:
    return run(_page(kind), f"return module.{function}({json.dumps(question)})")


def _of_live(machine: Limited, given: dict[str, Any] | None = None) -> dict[str, Any]:
    """What a controller's page is told of the machine, from the entry of its settings."""
    entry = dict(machine.given if given is None else given)
    return dict(machine_of({"mechanism": machine.mechanism.name, **entry}, machine.path, None).given)


@KINDS
def test_the_page_and_its_controller(kind: str) -> None:
    """Where it stands, what it is asked for, its solutions, a slice, a line, and what a controller moves it to."""
    machine, (expected, poses, _) = limited_machine(kind), _asked(kind)
    given = dict(machine.given) if kind == GIVEN else {}  # the page itself knows the machine
    found = _told(
        kind, "asked", name=machine.mechanism.name, parameters=given, machine=_of_live(machine),
        base=list(machine.base), poses=poses,
    )  # fmt: skip
    assert _are_inside(machine, found["start"])
    for said, pose, answer in zip(expected, poses, found["answers"], strict=True):
        assert [_axis(answer[way]) for way in ("stands", "aimed", "live")] == [said] * 3
        assert _axis(answer["line"]) == said or _is_wide(machine, said)  # it comes on the turn of its begin
        assert answer["followed"] == pose["axes"]
        assert answer["slice"] == (said == "")
        assert all(_are_inside(machine, axes) for axes in answer["solutions"])
        assert any(np.allclose(axes, pose["axes"], atol=1e-6) for axes in answer["solutions"]) == (said == "")


def _are_inside(machine: Limited, axes: list[float]) -> bool:
    return all(low - 1e-6 <= value <= high + 1e-6 for value, (low, high) in zip(axes, machine.ends, strict=True))


def _is_wide(machine: Limited, axis: str) -> bool:
    """Whether an axis has several turns inside its limits."""
    ends = dict(zip((a.name for a in machine.robot.AXES), machine.ends, strict=True))
    return axis in ends and ends[axis][1] - ends[axis][0] > 350.0


@STATED
def test_the_report(kind: str) -> None:
    """The machine that it draws and maps has the limits, and shows no pose beyond them."""
    machine, (expected, poses, _) = limited_machine(kind), _asked(kind)
    kinematics = machine.kinematics
    shown = nominal_machine(kinematics)
    columns = np.array([pose["axes"] for pose in poses]).T
    joints = kinematics.mechanism.joints
    inside = are_inside(shown, {j.axis.name: column for j, column in zip(joints, columns, strict=True)})
    assert list(inside) == [said == "" for said in expected]
    drawn = drawn_pose(shown)
    assert is_inside(shown, drawn) and _are_inside(machine, list(drawn.axes))
    (margin,) = kinematics.margins  # stretched or folded: both are beyond the limits of the elbow
    assert singular_pose(shown, derived_of(kinematics.solution), margin.name, drawn.axes) is None
    assert machine.robot.parameters.items() >= {(n, v) for n, v in shown.given.items() if n.startswith("lower_")}


@STATED
def test_the_maps(kind: str) -> None:
    """Every cell has the number of solutions that Python has there."""
    machine = limited_machine(kind)
    found = pictured(machine.kinematics, {})
    assert found.pose is not None and len(list(maps(found))) == 2
    rotation = np.reshape(found.pose.frame[3:], (3, 3))
    for part in slices(found.machine, found.pose.frame, found.pose.axes):
        rows, columns = part.solutions.shape
        for row, column in np.random.default_rng(3).integers(0, (rows, columns), (60, 2)):
            place = dict(part.at)
            for (low, high), name, k, count in zip(part.ends, part.along, (column, row), (columns, rows), strict=True):
                place[name] = low + (k + 0.5) * (high - low) / count
            slots = machine.robot.inverse_all(([place[c] for c in "xyz"], rotation), found.pose.axes)
            assert sum(slot.status == softkin.Status.OK for slot in slots) == part.solutions[row, column]
        assert part.solutions.max() == 1  # the other branch is beyond the limits of the elbow


@STATED
def test_a_stated_default_is_shown(kind: str) -> None:
    """The page starts with the machine that Python makes when nothing is given: `nominal` is of tests alone."""
    machine = limited_machine(kind)
    shown = _told(
        kind, "asked", name=machine.mechanism.name, parameters={}, machine=_of_live(machine),
        base=list(machine.base), poses=[],
    )["shown"]  # fmt: skip
    assert shown == dict(machine.robot.parameters)


@STATED
def test_limits_that_are_lifted(kind: str) -> None:
    """By a controller's settings, and in the fields of the page: both say so, and the copied Python does."""
    machine, name = limited_machine(kind), limited_machine(kind).mechanism.name
    lifted = machine.robot.changed(limits={"A1": None, "A3": (None, 5)}).to_dict()
    limits = {one["name"]: (one["lower"], one["upper"]) for one in
              _told(kind, "limitsOfLive", machine=_of_live(machine, lifted), name=name)}  # fmt: skip
    assert limits == {"A1": (None, None), "A2": machine.ends[1], "A3": (None, 5), "A4": machine.ends[3]}
    words = {"package": "softkin", "classes": {name: "Own"}, "keywords": {}}
    changes = [["upper_a1", None], ["lower_a1", None], ["upper_a2", None]]
    text = _told(kind, "copied", name=name, changes=changes, words=words)
    assert f'limits={{"A1": None, "A2": ({float(machine.ends[1][0])!r}, None)}}' in text
    assert "limits" not in _told(kind, "copied", name=name, changes=[], words=words)


def test_the_address_names_a_machine() -> None:
    """By its mechanism or its block; an unknown name is told, and no name is none."""
    machine = limited_machine(GIVEN).mechanism
    read = [run(_page(GIVEN), f"return module.read({json.dumps(text)})") for text in (
        f"#machine={machine.name}", f"#machine={machine.block_name}", "#machine=nonsense", "#axes=1,2", ""
    )]  # fmt: skip
    assert [one and one.get("name", one.get("unknown")) for one in read] == [
        machine.name, machine.name, "nonsense", None, None,
    ]  # fmt: skip
    assert "unknown" in read[2] and "name" not in read[2]
