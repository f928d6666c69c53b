"""What is typed into fields, copied, plotted and moved: poses, limits, addresses, lines and slices."""

import csv
import io
import re
from math import isclose
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import softkin

from tests.view.pages import ARM, Seen, confirm, frame_of, robot_of

pytestmark = pytest.mark.slow


def test_a_refusal_is_told(seen: Seen) -> None:
    """The sentence of `diagnose` with its amount, and the part of the machine that refuses is marked."""
    refused = seen["refused"]
    target = softkin.Frame.from_euler(*(float(t) for t in refused["shownTool"][3:]), refused["frame"]["position"])
    asked = softkin.Frame((700.0, *refused["frame"]["position"][1:]), target.rotation)
    told = robot_of(refused).diagnose(asked, refused["branches"], reference=refused["axes"])
    assert told is not None
    assert refused["refusal"] == told.in_words
    assert told.in_words.startswith("A2: out of reach, missing ")
    assert refused["isMarked"]
    assert refused["axes"] == [20, 40, 5, 30]
    assert seen["reached"]["refusal"] is None
    assert not seen["reached"]["isMarked"]
    assert isclose(seen["reached"]["frame"]["position"][0], 400, abs_tol=1e-9)
    confirm(seen["reached"])


def test_dimensions_are_edited(seen: Seen) -> None:
    """A length of 0 is refused in a sentence, and leaves the machine as it was; another one changes it."""
    assert len(seen["dimension"]) == 1
    assert "must be more than 0 and at most 1000000000" in seen["dimension"][0]
    assert seen["afterWrong"]["parameters"]["link_length_1"] == 325
    assert seen["longer"]["parameters"]["link_length_1"] == 300
    confirm(seen["longer"])


def test_limits_and_keys(seen: Seen) -> None:
    """An axis beyond its limit is told and marked; arrow keys step by 1 and 10; a branch is chosen by its name."""
    assert seen["beyond"]["refusal"] == "A1: above its upper limit, missing 5.0 deg"
    assert seen["beyond"]["isMarked"]
    assert isclose(seen["stepped"]["axes"][0], 19, abs_tol=1e-9)
    assert seen["stepped"]["refusal"] is None
    assert "A1: above its upper limit" in seen["left"]["refusal"]
    assert len(seen["withoutGhosts"]["ghosts"]) == 0
    assert isclose(seen["away"][1], 0.9 * seen["away"][0], rel_tol=1e-9)
    order = seen["order"]
    assert order[:3] == ["To the values", "machine", "move"]
    assert order.index("canvas") < order.index("axis-0") < order.index("tool-X") < order.index("CSV")


def test_limits_of_a_description(seen: Seen) -> None:
    """Nobody gives them: the page has them from the description, and an axis beyond one is no regular pose."""
    inside, beyond = seen["own"]["inside"], seen["own"]["beyond"]
    assert inside["refusal"] is None and inside["state"] != "refused"
    assert (beyond["state"], beyond["refusal"]) == ("refused", "A1: above its upper limit, missing 50.0 deg")
    assert beyond["isMarked"] and beyond["parameters"]["upper_a1"] == 150


def test_an_end_of_a_limit_is_open(seen: Seen) -> None:
    """Two ends are taken together that are refused one by one; an empty field is no limit, also copied and restored."""
    assert len(seen["lowerAlone"]) == 1 and "lower_a1 below upper_a1" in seen["lowerAlone"][0]
    assert (seen["bothEnds"]["parameters"]["lower_a1"], seen["bothEnds"]["parameters"]["upper_a1"]) == (28, 60)
    found = seen["openEnd"]
    assert found["limits"] == {"A1": [None, 60]} == seen["openEndRestored"]["limits"]
    assert found["axes"][0] == -200 and found["refusal"] is None
    assert seen["endFields"] == [["", "60"], ["", ""]]
    assert seen["noLimit"]["limits"] == {} and seen["noLimit"]["parameters"]["upper_a1"] == 0
    assert seen["upperAlone"]["limits"] == {"A1": [None, 60]}  # where there were no limits, the other end is open
    confirm(found)
    names: dict[str, Any] = {}
    exec(seen["openEndCopied"], names)  # the text of the viewer
    assert names["robot"] == robot_of(found)
    assert np.allclose(names["axes"], found["axes"], rtol=0, atol=1e-9)


def test_an_address_is_restored(seen: Seen) -> None:
    """The address of a pose opens the same pose, to the last digit; that of a refusal the refusal."""
    assert "view=" not in seen["address"]
    assert seen["restored"]["axes"] == seen["dragged"]["axes"]
    assert seen["restored"]["machine"] == ARM
    assert seen["refusedRestored"]["refusal"] == seen["refused"]["refusal"] is not None


def test_an_unknown_machine_is_told(seen: Seen) -> None:
    """The page shows a machine that it has, and says that it does not have the one of the address."""
    assert seen["own"]["unknown"] == "unknown machine: nonsense"


def test_where_one_looks_from_is_in_the_address(seen: Seen) -> None:
    """A picture that was turned opens as it is seen, to the digits of the address; the whole machine needs none."""
    camera = seen["camera"]
    assert "view=" not in camera["fitted"] and "view=" not in camera["again"]
    assert camera["turned"].startswith(f"{camera['fitted']}&view=")
    size = np.linalg.norm(np.subtract(camera["here"][:3], camera["here"][3:]))
    assert np.allclose(camera["here"], camera["there"], rtol=0, atol=1e-4 * size)


def test_a_pose_of_a_machine_of_ones_own_is_copied(
    seen: Seen, pages: tuple[Path, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the package that `softkin derive` writes: a dimension called as a word of Python has its keyword."""
    monkeypatch.syspath_prepend(str(pages[1].parent / "python"))
    names: dict[str, Any] = {}
    exec(seen["own"]["copied"], names)  # the text of the viewer
    assert names["robot"].parameters["lambda_"] == seen["own"]["pose"]["parameters"]["lambda"] == 225
    assert np.allclose(names["axes"], seen["own"]["pose"]["axes"], rtol=0, atol=1e-9)


def test_a_pose_is_copied(seen: Seen) -> None:
    """The Python is executed and gives the axes; the block's bytes and the CSV are those of the pose."""
    pose, names = seen["copied"]["pose"], {}
    exec(seen["copied"]["Python"], names)  # the text of the viewer
    assert np.allclose(names["axes"], pose["axes"], rtol=0, atol=1e-9)
    assert np.allclose(names["frame"].matrix[:3, 3], pose["frame"]["position"], rtol=0, atol=1e-12)
    text = seen["copied"]["Structured Text"]
    written = [int(value) for value in re.findall(r"Config\.abyData\[\d\] := (\d+);", text)]
    assert written == [byte % 256 for byte in pose["configuration"]]
    values = [float(value) for value in re.findall(r"target\.c\.[XYZABC] := (-?[\d.]+);", text)]
    there = softkin.Frame.from_euler(*values[3:], values[:3])
    assert np.allclose(there.matrix[:3], np.column_stack([pose["frame"]["rotation"], pose["frame"]["position"]]))
    header, row = csv.reader(io.StringIO(seen["copied"]["CSV"]))
    assert [float(value) for value in row[:6]] == pose["axes"]
    assert header[:6] == [f"axis A{i}" for i in range(1, 7)]
    assert [int(value) for value in row[12:]] == pose["configuration"]


def test_a_line(seen: Seen) -> None:
    """A line through the inside of a SCARA is refused there, and told; another has a way, as Python says."""
    assert re.match(r"Refused from \d+ %: A2: out of reach, missing ", seen["crossing"]["said"])
    assert seen["crossing"]["stops"] == seen["crossing"]["curves"] == 4
    assert seen["line"]["said"].startswith("There is a way on this branch.")
    assert (seen["line"]["stops"], seen["line"]["path"]) == (0, 241)
    confirm(seen["halfway"])
    begin = seen["lineFrom"]["frame"]["position"]
    assert np.allclose(seen["halfway"]["frame"]["position"][:2], (np.add(begin, [350, 250, 0]) / 2)[:2], atol=1e-9)
    assert len(seen["halfway"]["ghosts"]) == 1
    assert seen["played"]["axes"] != seen["halfway"]["axes"]
    confirm(seen["played"])


def test_a_line_is_marked(seen: Seen) -> None:
    """Through the centre of a polar machine its axis jumps by half a turn, there alone; a limit ends another line."""
    assert (seen["jump"]["jumps"], seen["jump"]["singular"], seen["jump"]["stops"]) == (2, 2, 0)  # in both plots
    assert seen["jump"]["said"].endswith("An axis jumps.")
    assert (seen["limit"]["limits"], seen["limit"]["stops"], seen["limit"]["jumps"]) == (1, 3, 0)
    assert "A1: above its upper limit, missing" in seen["limit"]["said"]


def test_a_slice(seen: Seen) -> None:
    """Every cell has the number of solutions, and the margin, that Python has there."""
    pose, found = seen["slicePose"], np.array(seen["slice"]["values"])
    origin, along, up = (np.array(corner) for corner in seen["slice"]["corners"])
    places = (np.arange(96) + 0.5) / 96
    points = np.array([[origin + a * along + (1 - b) * up for a in places] for b in places]).reshape(-1, 3)
    robot = robot_of(pose)
    rotations = np.broadcast_to(np.array(pose["frame"]["rotation"]), (len(points), 3, 3))
    counts = np.zeros(len(points), int)
    for byte in (1, 2):
        configuration = [byte, *[0] * (len(pose["configuration"]) - 1)]
        axes, statuses = robot.inverse_batch(points, rotations, configuration, pose["axes"])
        counts += statuses == softkin.Status.OK
        if byte == pose["configuration"][0]:
            margins = np.array([abs(robot.singularity(a).margins["elbow"]) for a in axes[statuses == 0][::97]])
            shown = np.array(seen["margin"]["values"]).reshape(-1)[statuses == 0][::97]
            assert np.allclose(shown, margins, atol=1e-6)
    assert np.array_equal(np.where(counts > 0, counts, -1), found.reshape(-1))
    assert 0.3 < (counts > 0).mean() < 0.9


def test_the_tool_is_dragged(seen: Seen) -> None:
    """A drag by the mouse gives axes that Python confirms, on the branches of before, with the rotation of before."""
    before, after = seen["before"], seen["dragged"]
    confirm(before)
    confirm(after)
    moved = np.subtract(after["frame"]["position"], before["frame"]["position"])
    assert np.linalg.norm(moved) > 20
    assert np.allclose(after["frame"]["rotation"], before["frame"]["rotation"], rtol=0, atol=1e-12)
    assert after["branches"] == before["branches"]
    assert np.abs(np.subtract(after["axes"], before["axes"])).max() > 1


def test_the_tool_is_turned(seen: Seen) -> None:
    """A drag of the handles of orientation turns the tool, and leaves it where it is."""
    before, after = seen["restored"], seen["turned"]
    confirm(after)
    assert np.allclose(after["frame"]["position"], before["frame"]["position"], rtol=0, atol=1e-9)
    cosine = (np.trace(np.array(before["frame"]["rotation"]).T @ after["frame"]["rotation"]) - 1) / 2
    assert 0.2 < np.degrees(np.arccos(cosine)) < 90


def test_a_ghost_is_taken(seen: Seen) -> None:
    """A click on a ghost: other axes, one of the solutions that Python lists, at the same frame."""
    taken, before = seen["taken"], seen["dragged"]
    confirm(taken)
    assert np.allclose(taken["frame"]["position"], before["frame"]["position"], rtol=0, atol=1e-9)
    assert taken["configuration"] != before["configuration"]
    every = robot_of(before).inverse_all(frame_of(before), reference=before["axes"])
    assert len(before["ghosts"]) == sum(slot.status == softkin.Status.OK for slot in every) - 1 == 7
    for ghost in before["ghosts"]:
        assert any(np.allclose(ghost, slot.axes, rtol=0, atol=1e-8) for slot in every)


def test_a_controller_moves_it(seen: Seen) -> None:
    """The machine of the greeting stands where the axes say; a value that is not good moves nothing; a loss is told."""
    live = seen["live"]
    assert live["axes"] == [10, 20, -30, 40] == seen["liveKept"]["axes"]
    assert (live["parameters"]["link_length_1"], live["parameters"]["upper_a1"]) == (300, 170)
    assert live["limits"] == {"A3": [None, 0], "A4": [-300, None]}
    assert live["parameters"]["pitch_zc"] == 0  # its default, not the nominal value of a drawing
    confirm(live)
    arm = np.array(seen["liveBodies"]["after"][1]["rotation"])  # the body that A1 turns
    assert np.allclose(arm[:2, 0], [np.cos(np.radians(10)), np.sin(np.radians(10))])
    assert seen["liveAsked"]["protocols"] == ["softkin.live.1", "token.abc"]
    assert seen["liveWords"][0] == "live"
    assert seen["liveWords"][1] == "live, axis 2 bad"
    assert seen["liveUnknown"].startswith("this page cannot show the machine: there is no parameter of this name: tool")
    assert seen["liveWords"][2] == "live" and seen["liveNotMoved"]["axes"] != [1, 2]
    assert seen["liveMounted"] == {"said": "OPC UA: connecting", "name": "Kin_Gantry2", "axes": [3, 4], "upper": 99}
    assert "no connection" in seen["liveWords"][3]
