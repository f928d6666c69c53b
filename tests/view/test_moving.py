"""What moves the machine: the handles of the tool, a ghost that is clicked, and a controller."""

import numpy as np
import pytest
import softkin

from tests.view.states import Seen, confirm, frame_of, robot_of

pytestmark = pytest.mark.slow


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
