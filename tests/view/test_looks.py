"""What is seen of machines: the choice, their bodies, labels, ghosts of assembly modes; nothing leaves the picture."""

import re
from itertools import combinations

import numpy as np
import pytest
import softkin

from tests.catalogue.platform_poses import points_of
from tests.mechanisms import catalogue, named
from tests.view.pages import ARM, Seen, confirm, frame_of, robot_of

pytestmark = pytest.mark.slow
EACH = pytest.mark.parametrize("name", [mechanism.name for _, mechanism in catalogue()])
SCARA = "Kin_Scara3_Z"


def test_all_poses_of_a_platform(seen: Seen) -> None:
    """Each leg has its length in every pose that is shown; how they were found is said; a click shows one alone."""
    found = seen["poses"]
    base, platform = (points_of(found["parameters"], side, "xyz") for side in ("base", "platform"))
    frames = found["all"]["frames"]
    for frame in frames:
        ends = np.array(frame["position"]) + platform @ np.array(frame["rotation"]).T
        assert np.allclose(np.linalg.norm(ends - base, axis=1), found["axes"], rtol=0, atol=1e-6)
    count = len(found["listed"])
    assert count == len(frames) + 1 == found["all"]["drawn"] + 1 and count >= 4
    assert found["said"].startswith(f"{count} poses found, by Newton's method from 1000 starts")
    assert found["said"].endswith("This is a search, no proof: there may be more.")
    assert sum("the pose that is shown" in text for text in found["listed"]) == 1
    assert len(found["alone"]["frames"]) == found["alone"]["drawn"] == 1
    assert found["moved"] == {"frames": [], "drawn": 0, "isListed": False} and not found["ofAnArm"]


def test_the_page_opens_with_the_six_axis_arm(seen: Seen) -> None:
    """Solutions come first, then axes, tool, margins and configuration."""
    assert seen["choice"]["first"]["machine"] == ARM
    expected = ["Solutions", "Axes", "Tool frame", "Singularity margins", "Configuration"]
    assert seen["choice"]["sections"][:5] == expected


def test_machines_are_chosen_by_families_and_found_by_their_names(seen: Seen) -> None:
    """Each with its picture; by the name of the mechanism, of the block, of the class, and by words of its summary."""
    choice, names = seen["choice"], sorted(mechanism.name for _, mechanism in catalogue())
    assert choice["families"] == sorted({mechanism.family.replace("_", " ") for _, mechanism in catalogue()})
    assert sorted(choice["all"]) == names and choice["pictures"] > 5
    assert named(SCARA).block_name != SCARA and choice["byBlock"] == [SCARA]
    assert choice["byClass"] == [SCARA, "Kin_Scara3_ZCCC"]
    assert ARM in choice["byWords"] and SCARA not in choice["byWords"]
    assert choice["none"] == [] and choice["said"] == "No machine has such a name."
    assert choice["taken"] == {"name": SCARA, "isOpen": False, "button": SCARA}
    assert choice["clicked"] == {"name": "Kin_Gantry2", "isOpen": False}


def test_refused_slots_are_folded(seen: Seen) -> None:
    """Out of reach nothing is listed as a solution: both slots say why, below a fold."""
    assert seen["refusedSlots"]["open"] is False and seen["refusedSlots"]["listed"] == 0
    assert re.match(r"2 refused.*out of reach.*out of reach", seen["refusedSlots"]["textContent"])


def test_a_slice_is_finer_at_its_border(seen: Seen) -> None:
    """Where two cells that touch have another number, 16 parts of each have the number that Python has there."""
    found, pose = seen["slice"], seen["slicePose"]
    values = np.array(found["values"])
    different = np.zeros(values.shape, bool)
    for shift in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here = (slice(0, 96 - shift[0]), slice(max(0, -shift[1]), 96 - max(0, shift[1])))
        there = (slice(shift[0], 96), slice(max(0, shift[1]), 96 + min(0, shift[1])))
        differs = values[here] != values[there]
        different[here] |= differs
        different[there] |= differs
    assert {(part["row"], part["column"]) for part in found["parts"]} == set(zip(*np.nonzero(different), strict=True))
    assert len(found["parts"]) > 100
    origin, along, up = map(np.array, found["corners"])
    fine = (np.arange(4) + 0.5) / 4
    places = [((p["column"] + a) / 96, (p["row"] + d) / 96) for p in found["parts"] for d in fine for a in fine]
    points = np.array([origin + a * along + (1 - d) * up for a, d in places])
    rotations = np.broadcast_to(np.array(pose["frame"]["rotation"]), (len(points), 3, 3))
    robot, turns = robot_of(pose), [0] * (len(pose["configuration"]) - 1)
    statuses = [robot.inverse_batch(points, rotations, [byte, *turns], pose["axes"])[1] for byte in (1, 2)]
    counts = np.sum([status == softkin.Status.OK for status in statuses], axis=0)
    shown = np.array([part["values"] for part in found["parts"]]).reshape(-1)
    assert np.array_equal(np.where(counts > 0, counts, -1), shown)
    assert 0.2 < (counts > 0).mean() < 0.8


def test_a_machine_that_leaves_the_picture_is_brought_back(seen: Seen) -> None:
    """A button is offered while part of it is outside, by the camera or by an axis; it looks at all of the machine."""
    assert seen["brought"] == [False, True, False, True, False]


def test_the_other_assembly_mode_is_a_ghost(seen: Seen) -> None:
    """It stands where Python has the machine in the other mode at the same axes; a click takes it."""
    before, after = seen["assembly"]["before"], seen["assembly"]["after"]
    other = {**before, "parameters": {**before["parameters"], "tcp_above": True}}
    assert before["parameters"]["tcp_above"] is False
    there = robot_of(other).forward(before["axes"])[0].position
    assert np.allclose(there, seen["assembly"]["there"], rtol=0, atol=1e-9)
    assert np.linalg.norm(np.subtract(there, frame_of(before)[0])) > 100
    assert "other assembly mode" in seen["assembly"]["labels"]
    assert after["parameters"]["tcp_above"] is True and after["axes"] == before["axes"]
    confirm(after)
    assert seen["assembly"]["hidden"]


@EACH
def test_labels_do_not_pile_up(name: str, seen: Seen) -> None:
    """No label lies on another, all axes have one, and the base has its letters; the whole machine is inside."""
    found = seen["machines"][name]
    for one, other in combinations(found["labels"], 2):
        sides = (("x", "width"), ("y", "height"))
        apart = [abs(one[at] - other[at]) - min(one, other, key=lambda label: label[at])[size] for at, size in sides]
        assert max(apart) > -2 or one["kind"] == other["kind"] == "letter", (one, other)
    words = {word for label in found["labels"] if not label["kind"] for word in label["text"].split()}
    assert {joint.name for joint in named(name).joints} <= words or named(name).drives
    assert [label["text"] for label in found["labels"] if label["kind"]] == ["X", "Y", "Z"]
    assert re.fullmatch(r"grid 10*u?(\.0*1)? u|grid 0\.0*1 u|grid 1e-?\d+ u", found["scale"])
    assert not found["isOutside"]


def test_machines_look_like_machines(seen: Seen) -> None:
    """Rails are beams, quills round, tables discs; an arm has barrels alone."""
    shapes = {name: found["shapes"] for name, found in seen["machines"].items()}
    assert set(shapes[ARM]) == {"barrel"}
    assert shapes["Kin_Gantry3"] == ["beam"] * 3
    assert shapes["Softkin_TableTable_AC"] == ["table", "trunnion", "beam", "beam", "beam"]
    assert shapes["Softkin_HeadTable_AC"] == ["table", "beam", "beam", "beam", "barrel"]
    assert shapes["Kin_Scara2_Z"] == ["barrel", "barrel", "quill"]
    assert shapes["Kin_Tripod_Linear"] == ["beam"] * 3
    tables = [name for name, found in shapes.items() if found.count("beam") == 3 and "table" in found]
    heights = [seen["machines"][name]["frame"]["position"][2] for name in tables]
    assert len(heights) > 5 and min(heights) > 0  # the tool stands above the work


@pytest.mark.parametrize(
    "name", ["Softkin_TableTable_AC", "Softkin_NutatingTable_BC", "Softkin_HeadTable_AC", "Kin_Gantry3"]
)
def test_tables_tilt_and_slides_stand(name: str, seen: Seen) -> None:
    """Z of the machine points up, whatever its tables do; the work tilts with a table that tilts."""
    before, after = (np.array(seen["tilted"][name][which]) for which in ("before", "after"))
    assert np.allclose(np.abs(before[0]), (0, 0, 1), atol=1e-9)
    assert np.allclose(after[0], before[0], atol=1e-9)
    assert (np.linalg.norm(after[1] - before[1]) > 0.1) == ("Table_" in name and "Head" not in name)
