"""One machine in Python and in Structured Text: both give the same answers, or both refuse."""

from collections.abc import Mapping, Sequence

import numpy as np
import softkin
from softkin import KinematicsError

from derive.description.mechanism import Mechanism
from derive.pipeline import Built
from tests.machines.made import built_of, imported_class
from tests.text.controller import OK, Controller
from tests.text.units import compiled_text

Answer = tuple[softkin.Frame, tuple[int, ...]]


def in_both(mechanism: Mechanism, offsets: Mapping[str, float]) -> tuple[Built, softkin.Mechanism, Controller]:
    """What is derived of a machine of nominal dimensions, and the machine itself in both languages."""
    built = built_of(mechanism)
    robot = imported_class(mechanism, built)(**{p.name: p.nominal for p in mechanism.parameters}, **offsets)
    controller = Controller(compiled_text(f"{mechanism.name}.st", built.parts["st"]["text"]), mechanism)
    assert controller.initialise(robot.parameters) == OK
    return built, robot, controller


def forward_in_both(
    controller: Controller, robot: softkin.Mechanism, axes: Sequence[float], size: float, turned: float = 1e-12
) -> Answer | None:
    """The frame and the configuration; None where both refuse. turned: how far entries of rotations may be apart."""
    status, answer = controller.forward(axes)
    try:
        frame, configuration = robot.forward(axes)
    except KinematicsError:
        assert status != OK
        return None
    assert status == OK
    assert np.allclose(answer[0], frame.position, rtol=0.0, atol=1e-9 * size)
    assert np.allclose(answer[1], frame.rotation, rtol=0.0, atol=turned)
    assert answer[2][: len(configuration)] == tuple(byte % 256 for byte in configuration)
    assert controller.is_singular(axes) == robot.singularity(axes).is_singular
    return frame, configuration


def inverse_in_both(
    controller: Controller, robot: softkin.Mechanism, frame: softkin.Frame, near: Sequence[float], within: float = 1e-7
) -> list[tuple[float, ...]]:
    """The answers of all slots. within: how far those of the block may be from those of Python."""
    answered = []
    for slot in robot.inverse_all(frame, near):
        status, found = controller.inverse(frame.position, frame.rotation, slot.configuration, near)
        assert (status == OK) == (slot.axes is not None)
        if slot.axes is not None:
            assert np.allclose(found[: len(slot.axes)], slot.axes, rtol=0.0, atol=within)
            answered.append(slot.axes)
    return answered
