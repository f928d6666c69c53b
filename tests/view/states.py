"""A state of the viewer, held against the Python package."""

from typing import Any

import numpy as np
import softkin

Seen = dict[str, Any]
ARM = "Kin_ArticulatedRobot_6DOF"


def robot_of(state: Seen) -> Any:
    """The machine of a state in Python."""
    return softkin.catalogue()[state["machine"]](**state["parameters"], limits=state["limits"])


def frame_of(state: Seen) -> Any:
    """The frame of a state."""
    return state["frame"]["position"], state["frame"]["rotation"]


def confirm(state: Seen) -> None:
    """Python finds the same frame and configuration at the axes, and these axes from both; the fields show them."""
    robot = robot_of(state)
    frame, configuration = robot.forward(state["axes"])
    assert np.allclose(frame.position, state["frame"]["position"], rtol=0, atol=1e-9)
    assert np.allclose(frame.rotation, state["frame"]["rotation"], rtol=0, atol=1e-12)
    assert list(configuration) == state["configuration"]
    axes = robot.inverse(frame, configuration, reference=state["axes"])
    assert np.allclose(axes, state["axes"], rtol=0, atol=1e-8)
    shown = [float(text) for text in state["shownAxes"]]
    assert np.allclose(shown, state["axes"], rtol=0, atol=6e-5)
    margins = robot.singularity(state["axes"]).margins
    assert margins.keys() == state["margins"].keys()
    assert np.allclose(list(margins.values()), list(state["margins"].values()), rtol=0, atol=1e-11)
