"""A sample project of a machine: a program that moves it, a panel to jog it, its drawing that moves with the axes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from derive.description.mechanism import DescriptionError
from derive.drawing.parts import wire_frame_of
from derive.drawing.pose import nominal_machine
from derive.emit.setup import with_constants
from derive.emit.softmotion.base import BASE_VARIABLES
from derive.emit.softmotion.block import Block
from derive.emit.softmotion.inputs import inputs, parameter_input
from derive.emit.softmotion.methods import spelled_inputs
from derive.emit.softmotion.self_test import stated
from derive.emit.st.contract import Contract, Parameter, Signature
from derive.emit.st.expression import literal
from derive.emit.st.layout import packed
from derive.emit.st.names import free
from derive.emit.st.program import Printed, printed
from derive.emit.st.refusal import Refusal
from derive.ir.program import Program
from derive.kinematics.kinematics import Kinematics
from derive.report.demo import Demo, demo_of
from derive.report.reference_calls import Machine

FOLDER = "samples"
_SPEEDS = {"velocity": 5.0, "acceleration": 20.0, "jerk": 100.0, "step": 1.0}
"""In units of the demonstration."""
_TOOL = -1
"""The place of the tool among the ends of lines."""
_POINT = {"x": "v.dX", "y": "v.dY", "z": "v.dZ"}


@dataclass(frozen=True)
class Sample:
    """The values that the template of a sample project reads."""

    block: Block
    head: str
    """The declaration of the method that computes the points."""
    program: Printed
    points: tuple[tuple[str, ...], ...]
    """The expressions of the points between which lines are drawn; the last one is the flange."""
    ends: tuple[int, ...]
    """The points of every line: where it begins, and where it ends."""
    drives: tuple[str, ...]
    dimensions: tuple[str, ...]
    """The lines of a call that gives the nominal dimensions."""
    demo: Demo
    start: tuple[tuple[str, str], ...]
    """The coordinates of the first point with their names, and in `end` those that the last point changes."""
    end: tuple[tuple[str, str], ...]
    speeds: Mapping[str, str]
    """Velocity, acceleration, jerk, and the step of a jog."""
    other: tuple[tuple[str, int], ...]
    """The inputs of the configuration block, each with the byte in the second configuration; nothing without one."""


def sample_of(kinematics: Kinematics, block: Block, contract: Contract) -> Sample | None:
    """The sample project; None of a machine that stands in no axis group alone, is not drawn, or follows no line."""
    mechanism = kinematics.mechanism
    if mechanism.is_orientation or contract.transformations or not mechanism.joints:
        return None
    try:
        parts, drawn = wire_frame_of(kinematics)
        machine = nominal_machine(kinematics)
        demo = demo_of(machine)
    except DescriptionError:  # a drawing is no part of the proof
        return None
    if demo is None:
        return None
    places = sorted({place for line in drawn for place in line[:2]} - {_TOOL})
    numbers = {place: number for number, place in enumerate((*places, _TOOL))}
    signature = _signature(contract, len(places))
    program = _printed(parts.program, kinematics, block, signature, contract)
    points = [tuple(program.outputs[name] for name in parts.names[place]) for place in places]
    used: set[str] = set()
    return Sample(
        block=block,
        head=signature.head(),
        program=program,
        points=(*points, tuple(_POINT.values())),
        ends=tuple(numbers[place] for line in drawn for place in line[:2]),
        drives=tuple(free(f"Drive_{joint.key.upper()}", used) for joint in mechanism.joints),
        dimensions=tuple(_dimensions(kinematics, machine)),
        demo=demo,
        start=tuple(zip("XYZABC", map(literal, (*demo.start, *demo.angles)), strict=True)),
        end=tuple((c, literal(b)) for c, a, b in zip("XYZ", demo.start, demo.end, strict=True) if a != b),
        speeds={name: literal(factor * demo.unit) for name, factor in _SPEEDS.items()},
        other=tuple(zip((b.choices[0].name for b in block.branches), demo.other or (), strict=False)),
    )


def _printed(
    program: Program, kinematics: Kinematics, block: Block, signature: Signature, contract: Contract
) -> Printed:
    spelled = {**inputs(kinematics).names, **_POINT, **spelled_inputs(kinematics)}
    taken = {i.name for i in block.inputs} | {name for name, _ in block.fields} | {"v", "aBranches", *BASE_VARIABLES}
    taken |= {p.name for p in signature.parameters} | {"NumAxes", *contract.private, *contract.signatures}
    refusal = Refusal(signature, contract.spelling["errors"], contract.spelling["types"]["error"])
    return printed(with_constants(program, kinematics, spelled), spelled, {}, taken, refusal)


def _dimensions(kinematics: Kinematics, machine: Machine) -> list[str]:
    """The lines of a call that gives the machine its inputs, those that differ from their defaults."""
    names = inputs(kinematics).names
    stating = ((parameter_input(p, names[p.name]), stated(p, machine.given)) for p in kinematics.parameters)
    changed = [f"{one.name} := {value}" for one, value in stating if value != one.default]
    return packed([f"{one}," for one in changed[:-1]] + [f"{one});" for one in changed[-1:]])


def _signature(contract: Contract, last: int) -> Signature:
    types = contract.spelling["types"]
    points = Parameter("VAR_IN_OUT", "aPoints", f"ARRAY[0..{last}, 0..2] OF LREAL")
    return Signature("Draw", types["error"], (points, Parameter("VAR_IN_OUT CONSTANT", "a", types["axes"])))
