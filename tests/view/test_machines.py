"""Every machine of the catalogue is drawn, and the part of it that refuses is marked."""

import re

import numpy as np
import pytest
import softkin

from tests.mechanisms import catalogue
from tests.view.states import Seen

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", [mechanism.name for _, mechanism in catalogue()])
def test_every_machine_is_drawn(name: str, seen: Seen) -> None:
    """Its bodies alone cover part of the picture; it stands where Python says, with all its solutions."""
    found = seen["machines"][name]
    assert found["refusal"] is None
    assert found["covered"] > 500
    assert found["isLabelled"]
    robot = softkin.catalogue()[name](**found["parameters"])
    if not found["axes"]:
        return
    frame, configuration = robot.forward(found["axes"])
    tolerance = 1e-6 if name in ("Kin_Hexapod", "Softkin_Hexaglide", "Softkin_Planar_3RRR") else 1e-9  # iterated
    assert np.allclose(frame.position, found["frame"]["position"], rtol=0, atol=tolerance)
    assert list(configuration) == found["configuration"]
    there = (found["frame"]["position"], found["frame"]["rotation"])
    slots = robot.inverse_all(there, reference=found["axes"])
    assert sum(slot.status == softkin.Status.OK for slot in slots) == found["solutions"]


@pytest.mark.parametrize("name", [mechanism.name for _, mechanism in catalogue() if mechanism.joints])
def test_the_part_that_refuses_is_marked(name: str, seen: Seen) -> None:
    """Far away every machine that ends somewhere refuses: the axis or the rod is marked that its sentence names."""
    found = seen["machines"][name]["farAway"]
    if found["reason"] is None:
        assert found["marked"] == []
        return
    subject = re.split(r"[:,]| cannot | where ", found["reason"])[0]
    kinds = {part.partition(" ")[0] for part in found["marked"]}
    names = {part.partition(" ")[2] for part in found["marked"]}
    axes = {axis.name for axis in softkin.catalogue()[name].AXES}
    if subject in axes:
        assert names and all(subject in words.split() or kinds == {"rod"} for words in names)
    elif " " in subject:
        rod = subject.rpartition("rod ")[2]
        assert kinds == {"rod"} and {words.rstrip("ab") for words in names} == {rod}
    elif subject == "a3_from_a2":
        assert names == {"A2", "A2 A3", "A3"}
    else:
        assert kinds in ({"plate"}, {"tool"})
