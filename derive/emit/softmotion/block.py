"""The data of a function block that templates read: axes, configuration bytes, inputs and instance variables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from derive.description.mechanism import Joint, Kind, Turning
from derive.emit.softmotion.calls import (
    Command,
    branch_of,
    command_of,
    keeps_orientation,
    limit_reasons,
    offset_branch_of,
)
from derive.emit.softmotion.inputs import Input, inputs, parameter_input
from derive.emit.st.contract import Contract
from derive.emit.st.expression import literal
from derive.emit.st.names import capitalized, free, stored_name, type_name
from derive.emit.st.program import Printed
from derive.ir.constants import TIE
from derive.ir.passes import needed_for
from derive.ir.program import Program
from derive.ir.symbols import START_POSITION
from derive.ir.types import type_of
from derive.kept import kept_by_identity
from derive.kinematics.differential import is_of_length
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import CHECK_LIMITS, TIE_OF_LENGTHS, chooses_by_lengths

_FEW = 3
"""The most axes of the smaller user transformation."""
SETTINGS = "ISMKinematicAxisSettings"
"""The interface by which SoftMotion passes the limits of a drive."""
_OF_AXIS = {
    "offset": "offset",
    "unlimited": "unlimited",
    "lower": "lower",
    "upper": "upper",
    "lowest": "lowest",
    "highest": "highest",
    "single": "isSingle",
    "mid": "middle",
}
"""The constants of an axis: the beginnings of their neutral names, and their names in the structure of the axis."""


@dataclass(frozen=True)
class Axis:
    """One axis: its field in AXISPOS_REF, and its properties in the base block."""

    name: str
    field: str
    meaning: str
    output: str
    """The neutral name of the axis value in programs."""
    is_rotary: bool
    in_degrees: bool
    is_held: bool
    """Whether the inverse leaves it where the reference has it."""
    has_turns: bool
    turns: str
    """The turns of the joint per turn of the axis; empty without a gear."""


@dataclass(frozen=True)
class BranchByte:
    """A byte that chooses one of two branches: 1 is the first, 2 the second."""

    byte: int
    name: str
    stem: str
    first: str
    second: str
    inputs: tuple[str, str, str]
    """Of the configuration block: whether the first branch is chosen, or none; whether both coincide."""
    output: str

    @property
    def choices(self) -> tuple[Input, ...]:
        """The inputs of the configuration block that choose the branch."""
        meaning = f"{self.name}: TRUE {self.first}, FALSE {self.second}"
        return (
            Input(self.inputs[0], "BOOL", "TRUE", meaning),
            Input(self.inputs[1], "BOOL", "FALSE", f"{self.name}: nearest to the reference"),
        )


@dataclass(frozen=True)
class PeriodByte:
    """A byte with the signed period number of an axis."""

    byte: int
    index: int
    """The index of the axis, and so of its entry in GetPeriods."""
    axis: str
    field: str
    input: str
    turns: str = ""
    """The turns of the joint per turn of the axis, as a factor in front of its value; empty without a gear."""


@dataclass(frozen=True)
class Block:
    """A function block."""

    name: str
    title: str
    interfaces: tuple[str, ...]
    inputs: tuple[Input, ...]
    fields: tuple[tuple[str, str], ...]
    """The instance variables that hold constants of the programs, with their types."""
    axes: tuple[Axis, ...]
    axis_fields: tuple[str, ...]
    branches: tuple[BranchByte, ...]
    periods: tuple[PeriodByte, ...]
    configuration_size: int
    freedom: str
    keeps_orientation: bool
    """Whether its flange has one orientation, and the methods of the base block are enough for its offsets."""
    turning: str
    """The part of the commanded rotation that the flange follows: a value of `Turning`."""
    refuses_flanges: bool
    """Whether this is an orientation kinematics that some flange cannot carry."""
    rows: tuple[str, ...]
    margins: tuple[str, ...]
    turn_rows: tuple[int, ...]
    """The rows of the Jacobian that are turns."""
    computed: tuple[tuple[str, str], ...]
    """The instance variables that ReadInputs assigns at its end, each with the output of `setup` that it holds."""
    has_settings: bool
    """Whether drives pass their limits to the block."""
    command: Command
    """The parts of a command that the inverse reads."""
    limit_reasons: tuple[int, ...]
    """The number of the reason that an axis is below its lower limit, for every axis; empty if the block tests more
    limits than those of its axes."""
    is_transformation: bool
    """Whether it is a user transformation of PacDrive, and no kinematics of SoftMotion."""
    tie: str
    """The difference up to which two squared distances count as equal; empty if it is computed, or not read."""

    def stored(self, program: Printed) -> list[tuple[str, str]]:
        """The instance variables and their values, given the text of `setup`."""
        return [(field, program.outputs[output]) for field, output in self.computed]

    @property
    def solves_offsets(self) -> bool:
        """Whether it has a solution of its own for the point of a tool: SolveOffsetBranch."""
        return not self.keeps_orientation and any("_Offset" in name for name in self.interfaces)

    @property
    def slots(self) -> int:
        """The number of solutions that the branches distinguish."""
        return int(2 ** len(self.branches))


def block_of(kinematics: Kinematics, contract: Contract) -> Block:
    """The function block of a mechanism."""
    mechanism, spelling = kinematics.mechanism, contract.spelling
    interfaces = _interfaces(kinematics, contract)
    axis_fields = tuple(spelling["axes"]["fields"])
    size = len(kinematics.branches)
    chosen = _chosen(kinematics)
    order = {joint.name: index for index, joint in enumerate(mechanism.joints)}
    return Block(
        name=mechanism.block_name,
        title=mechanism.title or mechanism.block_name,
        interfaces=interfaces,
        inputs=tuple(parameter_input(p, inputs(kinematics).names[p.name]) for p in kinematics.parameters),
        fields=_fields(kinematics),
        axes=tuple(
            _axis(j, f, is_held=j in mechanism.held_joints) for j, f in zip(mechanism.joints, axis_fields, strict=False)
        ),
        axis_fields=axis_fields,
        branches=tuple(_branch_byte(i, b.name, b.names, chosen[i]) for i, b in enumerate(kinematics.branches)),
        periods=tuple(
            PeriodByte(
                size + i,
                order[j.name],
                j.name,
                axis_fields[order[j.name]],
                f"iPeriod{capitalized(j.key)}",
                f"{turns_of(j)}*" if j.is_geared else "",
            )
            for i, j in enumerate(kinematics.period_joints)
        ),
        configuration_size=kinematics.configuration_size,
        freedom=spelling["freedom"][kinematics.freedom.value],
        keeps_orientation=keeps_orientation(kinematics),
        turning=mechanism.task.turning.value,
        refuses_flanges=kinematics.compatible is not None and bool(kinematics.compatible.body),
        rows=kinematics.rows,
        turn_rows=tuple(k for k, row in enumerate(kinematics.rows) if not is_of_length(row)),
        margins=tuple(m.name for m in kinematics.margins),
        computed=_computed(kinematics),
        is_transformation=bool(contract.transformations),
        tie="" if chooses_by_lengths(mechanism) or not kinematics.branches else literal(float(TIE)),
        has_settings=SETTINGS in interfaces,
        command=command_of(kinematics),
        limit_reasons=limit_reasons(kinematics),
    )


def _fields(kinematics: Kinematics) -> tuple[tuple[str, str], ...]:
    types = {o.name: type_name(type_of(o.value)) for o in kinematics.setup.outputs}
    own = stored_in_base(kinematics)
    return tuple((stored_name(name), types[name]) for name in constants(kinematics) if name not in own)


@kept_by_identity(10)
def stored_in_base(kinematics: Kinematics) -> dict[str, str]:
    """The constants that the base block holds, most of them in the structure of an axis, with the spelling of each."""
    of_axes = {
        f"{word}_{joint.key}": f"axes[{index}].{member}"
        for index, joint in enumerate(kinematics.mechanism.joints)
        for word, member in _OF_AXIS.items()
    }
    start = start_in("home")
    held = {o.value: start[o.name] for o in kinematics.setup.outputs if o.name in start and o.value.is_Symbol}
    same = {o.name: held[o.value] for o in kinematics.setup.outputs if o.value in held}
    return of_axes | {TIE_OF_LENGTHS.name: "tie"} | same | start


def start_in(structure: str) -> dict[str, str]:
    """The start of forward kinematics in a structure, with the spelling of each of its numbers."""
    position = {s.name: f"{structure}.v.d{c.upper()}" for s, c in zip(START_POSITION, "xyz", strict=True)}
    return position | {f"start_r{r}{c}": f"{structure}.rot[{r}, {c}]" for r in (1, 2, 3) for c in (1, 2, 3)}


def stored_as(kinematics: Kinematics, name: str) -> str:
    """The spelling of a constant: an instance variable, or a member of the structure of an axis."""
    return stored_in_base(kinematics).get(name) or stored_name(name)


def _computed(kinematics: Kinematics) -> tuple[tuple[str, str], ...]:
    setup = setup_of(kinematics)
    given, bound = {o.name for o in setup.outputs}, set(direct(kinematics, setup).values())
    done = {stored_as(kinematics, o) for o in bound}
    found = {stored_as(kinematics, o): o for o in reversed(constants(kinematics)) if o in given}
    return tuple((place, o) for place, o in reversed(found.items()) if place not in done)


def programs_of(kinematics: Kinematics) -> tuple[Program, ...]:
    """The programs of all methods but Initialize."""
    found: Sequence[Program | None] = (
        kinematics.forward,
        None if keeps_orientation(kinematics) else kinematics.orientation,
        branch_of(kinematics),
        kinematics.limits,
        kinematics.singularity,
        kinematics.jacobian,
        kinematics.bias,
        kinematics.image,
        kinematics.projection,
        offset_branch_of(kinematics),
        None if keeps_orientation(kinematics) else kinematics.offset_configuration,
        kinematics.compatible,
        kinematics.end_point_shift,
        kinematics.total_image,
    )
    return tuple(p for p in found if p is not None)


@kept_by_identity(10)
def constants(kinematics: Kinematics) -> tuple[str, ...]:
    """The neutral names of the constants that Initialize stores: the outputs of `setup` that a method reads."""
    read = {symbol.name for program in programs_of(kinematics) for symbol in program.reads()}
    for joint in kinematics.mechanism.joints:
        read |= {f"{word}_{joint.key}" for word in ("unlimited", "lower", "upper")}
    if chooses_by_lengths(kinematics.mechanism):
        read.add(TIE_OF_LENGTHS.name)
    return tuple(o.name for o in kinematics.setup.outputs if o.name in read)


def setup_of(kinematics: Kinematics) -> Program:
    """The program of ReadInputs, without values that no method reads, and without those that depend on the limits of a
    drive, which one function computes for every axis.
    """
    setup = kinematics.setup_less_windows
    stored = set(constants(kinematics)) | {CHECK_LIMITS}
    outputs = tuple(o for o in setup.outputs if o.name in stored)
    return replace(setup, body=needed_for(setup.body, [o.value for o in outputs]), outputs=outputs)


def direct(kinematics: Kinematics, setup: Program) -> dict[str, str]:
    """The values of `setup` that need no temporary variable, because an output holds them: name → output."""
    lets = {let.name.name for let in setup.lets()}
    stored = set(constants(kinematics))
    found: dict[str, str] = {}
    for output in setup.outputs:
        if output.name in stored and str(output.value) in lets:
            found.setdefault(str(output.value), output.name)
    return found


def _axis(joint: Joint, field: str, *, is_held: bool) -> Axis:
    return Axis(
        name=joint.name,
        field=field,
        meaning=joint.meaning,
        output=joint.axis.name,
        is_rotary=joint.kind is Kind.ROTARY,
        in_degrees=joint.in_degrees,
        is_held=is_held,
        has_turns=joint.multi_turn,
        turns=turns_of(joint) if joint.is_geared and joint.multi_turn else "",
    )


def turns_of(joint: Joint) -> str:
    """The turns of a joint with a gear per turn of its axis: a number, or the instance variable that holds it."""
    return literal(float(joint.turns)) if joint.turns.is_number else stored_name(str(joint.turns))


def _chosen(kinematics: Kinematics) -> list[tuple[str, str, str]]:
    """The names of the inputs of every branch in the configuration block; none equals another, or that of a period."""
    used = {"config", *(f"iperiod{j.key}" for j in kinematics.period_joints)}
    found = []
    for branch in kinematics.branches:
        stem = f"x{capitalized(branch.name)}"
        names = [free(f"{stem}{word}", used) for word in ("Automatic", "Singular")]
        found.append((free(f"{stem}{capitalized(branch.names[0])}", used), names[0], names[1]))
    return found


def _branch_byte(byte: int, name: str, names: tuple[str, str], inputs: tuple[str, str, str]) -> BranchByte:
    return BranchByte(byte, name, capitalized(name), names[0], names[1], inputs, f"branch_{name}")


def _interfaces(kinematics: Kinematics, contract: Contract) -> tuple[str, ...]:
    if contract.transformations:
        is_small = kinematics.mechanism.task.turning is Turning.NONE and len(kinematics.mechanism.joints) <= _FEW
        return (contract.transformations[0 if is_small else 1],)
    has_configuration = kinematics.configuration_size > 0
    wanted = ["ISMKinematicWithInfo2", "ISMKinematicWithInitialization"]
    if has_configuration:
        wanted.append("ISMKinematicWithConfigurations4")
    if kinematics.period_joints:
        wanted += ["ISMKinPeriodHandling", SETTINGS]
    if kinematics.mechanism.is_orientation:
        wanted += ["ISMOrientationKinematics3", "ISMToolKinematics2", "ISMOrientationKinematicsWithOriImage2"]
    elif kinematics.mechanism.is_position and kinematics.offset_branch is None:
        wanted.append("ISMPositionKinematics2")
    elif kinematics.mechanism.is_position:
        wanted.append("ISMPositionKinematics_Offset2" if has_configuration else "ISMPositionKinematics_Offset")
    if kinematics.projection is not None and not kinematics.mechanism.is_orientation:
        wanted.append("ISMKinematicsWithOrientationImage2")
    return tuple(name for name in map(contract.available, wanted) if name is not None)
