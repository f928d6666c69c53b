"""The function of each program: the arrays that it takes apart, and the shape of its result."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from derive.drawing.parts import Parts
from derive.emit.javascript.printer import function_name
from derive.equations.limits import value_of
from derive.equations.rotation_repair import rotation_program
from derive.ir.passes import normalise
from derive.ir.program import Output, Program
from derive.ir.symbols import branch_sign
from derive.kinematics.kinematics import Kinematics

Shape = str | tuple["Shape", ...]
"""Names, nested as the arrays of arguments and results are."""
POSITION: tuple[Shape, ...] = ("x", "y", "z")
ROTATION: tuple[Shape, ...] = tuple(tuple(f"r{row}{column}" for column in "123") for row in "123")


@dataclass(frozen=True)
class Function:
    """A program with its place in the module."""

    summary: str
    program: Program
    arguments: tuple[tuple[str, tuple[Shape, ...]], ...]
    """Each with the names that the program reads of it."""
    result: tuple[Shape, ...] | None
    """None where the program only refuses."""
    key: str = ""
    """Its name among the programs that the runtime calls; empty where only other programs call it."""

    @property
    def name(self) -> str:
        """Its name in the module."""
        return function_name(self.program.name)

    @property
    def given(self) -> frozenset[str]:
        """The names of its arguments, besides the constants of the machine."""
        return frozenset(name for _, shape in self.arguments for name in names(shape))


def names(shape: Shape) -> Iterator[str]:
    """The names of a shape, in order."""
    if isinstance(shape, str):
        yield shape
    else:
        for part in shape:
            yield from names(part)


def rotation_function() -> Function:
    """The repair of a commanded rotation, which is the same for all mechanisms."""
    return Function("The rotation as it is used.", rotation_program(), (("rotation", ROTATION),), ROTATION)


def functions(kin: Kinematics, parts: Parts | None) -> list[Function]:
    """The functions of a module, each before its callers. parts: the drawn parts of a machine that has a drawing."""
    joints = kin.mechanism.joints
    axes = (("axes", tuple(j.axis.name for j in joints)),)
    pose = (("position", POSITION), ("rotation", ROTATION))
    margins = tuple(f"branch_{b.name}" for b in kin.branches)
    turns = ("turns", tuple(j.turn.name for j in kin.period_joints))
    reference = ("reference", tuple(j.reference.name for j in joints))
    choice = (("signs", tuple(branch_sign(b.name).name for b in kin.branches)), turns, reference)
    placed = (POSITION, ROTATION, margins)
    values = axes[0][1]

    def matrix(rows: int) -> tuple[Shape, ...]:
        return tuple(tuple(f"j{i}{k}" for k, _ in enumerate(joints, 1)) for i in range(1, rows + 1))

    found = [
        *shared(kin),
        Function("Position, rotation, and the signed margin of every branch.", kin.forward, axes, placed, "forward"),
        Function("The axes of one branch on their turns, before any limit.", kin.branch, (*pose, *choice), values,
                 "branch"),
        Function("The test of the limits.", kin.limits, axes, None, "limits"),
        Function("The margins, each zero at its singularity.", kin.singularity, axes,
                 tuple(m.name for m in kin.margins), "singularity"),
        Function("The Jacobian by rows, per radian.", kin.jacobian, axes, matrix(len(kin.rows)), "jacobian"),
    ]  # fmt: skip
    if parts is not None:
        text = "What is drawn: amounts and points, as `parts` of the description counts them."
        found.append(Function(text, parts.program, (*axes, *pose), parts.names, "parts"))
    if kin.limited:
        quantities = tuple(value_of(quantity) for quantity in kin.limited)
        program = normalise("quantities", kin.limits.lets(), [Output(q.name, q) for q in quantities])
        text = "The quantities beside the axes that have limits."
        found.append(Function(text, program, axes, tuple(q.name for q in quantities), "quantities"))
    if kin.search_given is not None and kin.from_joints is not None:
        given = tuple(o.name for o in kin.search_given.outputs)
        angles = (("joints", tuple(j.symbol.name for j in joints)), turns, reference)
        found.append(Function("The arguments of the search.", kin.search_given, (*pose, *choice), given, "searchGiven"))
        found.append(Function("The axes of joint values.", kin.from_joints, angles, values, "fromJoints"))
    return found


def shared(kin: Kinematics) -> list[Function]:
    """The functions of the programs that others call: argument and result are one array each."""
    constants = {o.name for o in kin.setup.outputs}
    found = []
    for program in kin.shared:
        given = tuple(s.name for s in program.inputs if s.name not in constants)
        outputs = tuple(o.name for o in program.outputs)
        found.append(Function(f"{program.summary}.", program, (("given", given),), outputs))
    return found
