"""The function of each program, with its arguments and the places of its results."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from derive.equations.limits import value_of
from derive.equations.rotation_repair import rotation_program
from derive.ir.passes import normalise
from derive.ir.program import FindRoot, Output, Program, expressions, reason_expressions, shared
from derive.ir.symbols import COORDINATE_NAMES, PLACE, branch_sign, symbols_of
from derive.kinematics.kinematics import Kinematics

_ROTATION = tuple((f"r{i + 1}{j + 1}", f"rotation[{i}][{j}]") for i in range(3) for j in range(3))
FRAME = (*((name, f"position[{i}]") for i, name in enumerate(COORDINATE_NAMES)), *_ROTATION)
_GIVEN_FRAME = "const softkin_frame *frame"
_CHOICE = "const int8_t *signs, const int8_t *turns, const double *reference"


@dataclass(frozen=True)
class Function:
    """A program with its place in the source."""

    summary: str
    program: Program
    parameters: str
    """The declarations of its parameters between the machine and the refusal."""
    given: Mapping[str, str]
    """The values that the program reads besides the constants of the machine, each with its place."""
    results: tuple[tuple[str, str], ...]
    """The outputs, each with its place."""
    key: str = ""
    """Its name among the programs of the mechanism; empty where only other programs call it."""
    is_of_machine: bool = True

    @property
    def name(self) -> str:
        """Its name in the source."""
        return function_name(self.program)


def function_name(program: Program) -> str:
    """The function of a program: `wrist_centre` → `find_wrist_centre`."""
    return f"find_{program.name.removeprefix('find_')}"


def read_by(program: Program) -> set[str]:
    """The names that a program itself reads, without those that only its called programs read."""
    return names_in(program) - {s.name for s in program.bound()}


def names_in(program: Program) -> set[str]:
    """The names that stand in the expressions of a program."""
    values = [e for s in program.body for e in (*expressions(s), *reason_expressions(s))] + [
        o.value for o in program.outputs
    ]
    given = {g.name for s in program.body if isinstance(s, FindRoot) for p in (s.trial, s.finish) for g in s.given(p)}
    return {s.name for value in values for s in symbols_of(value)} | given - {s.name for s in PLACE}


def rotation_function() -> Function:
    """The repair of a commanded rotation, which is the same for all mechanisms."""
    given, results = (tuple((name, f"{word}->{place}") for name, place in _ROTATION) for word in ("frame", "repaired"))
    parameters = f"{_GIVEN_FRAME}, softkin_frame *repaired"
    return Function("The rotation as it is used.", rotation_program(), parameters, dict(given), results,
                    is_of_machine=False)  # fmt: skip


def functions(kin: Kinematics) -> list[Function]:
    """The functions of a source, each before its callers."""
    joints = kin.mechanism.joints
    axes = _places("axes", [j.axis.name for j in joints])
    frame = {name: f"frame->{place}" for name, place in FRAME}
    turns = _places("turns", [j.turn.name for j in kin.period_joints])
    reference = _places("reference", [j.reference.name for j in joints])
    choice = _places("signs", [branch_sign(b.name).name for b in kin.branches]) | turns | reference
    margins = _places("margins", [f"branch_{b.name}" for b in kin.branches])
    placed = (*frame.items(), *margins.items())
    values, given_axes = tuple(axes.items()), "const double *axes"
    entries = [f"j{i}{k}" for i, _ in enumerate(kin.rows, 1) for k, _ in enumerate(joints, 1)]
    found = [
        Function("Position, rotation, and the signed margin of every branch.", kin.forward,
                 f"{given_axes}, softkin_frame *frame, double *margins", axes, placed, "forward"),
        Function("The axes of one branch on their turns, before any limit.", kin.branch,
                 f"{_GIVEN_FRAME}, {_CHOICE}, double *axes", frame | choice, values, "branch"),
        Function("The test of the limits.", kin.limits, given_axes, axes, (), "limit"),
        Function("The margins, each zero at its singularity.", kin.singularity, f"{given_axes}, double *margins", axes,
                 tuple(_places("margins", [m.name for m in kin.margins]).items()), "singularity"),
        Function("The Jacobian by rows, per radian.", kin.jacobian, f"{given_axes}, double *rows", axes,
                 tuple(_places("rows", entries).items()), "jacobian"),
    ]  # fmt: skip
    found += _further(kin, axes, frame | choice, turns | reference)
    return [*(_called(program, kin) for program in shared([one.program for one in found])), *found]


def _further(
    kin: Kinematics, axes: Mapping[str, str], asked: Mapping[str, str], near: Mapping[str, str]
) -> Iterator[Function]:
    """The functions of machines that limit other quantities than axes, or have a root scan."""
    if kin.limited:
        quantities = [Output(q.name, value_of(q)) for q in kin.limited]
        program = normalise("quantities", kin.limits.lets(), quantities)
        results = tuple(_places("values", [o.name for o in quantities]).items())
        yield Function("The quantities beside the axes that have limits.", program,
                       "const double *axes, double *values", axes, results, "quantities")  # fmt: skip
    if kin.search_given is not None and kin.from_joints is not None:
        results = tuple(_places("given", [o.name for o in kin.search_given.outputs]).items())
        yield Function("The arguments of the search.", kin.search_given,
                       f"{_GIVEN_FRAME}, {_CHOICE}, double *given", asked, results, "search_given")  # fmt: skip
        joints = _places("joints", [j.symbol.name for j in kin.mechanism.joints])
        parameters = "const double *joints, const int8_t *turns, const double *reference, double *axes"
        yield Function("The axes of joint values.", kin.from_joints, parameters, {**joints, **near},
                       tuple(axes.items()), "from_joints")  # fmt: skip


def _called(program: Program, kin: Kinematics) -> Function:
    """The function of a program that others call: argument and result are one array each."""
    given = _places("given", arguments_of(program, kin))
    results = _places("found", [o.name for o in program.outputs])
    parameters = "const double *given, double *found"
    return Function(f"{program.summary}.", program, parameters, given, tuple(results.items()))


def arguments_of(program: Program, kin: Kinematics) -> list[str]:
    """The inputs of a program that are no constants of the machine."""
    constants = {o.name for o in kin.setup.outputs}
    return [s.name for s in program.inputs if s.name not in constants]


def _places(array: str, names: Sequence[str]) -> dict[str, str]:
    return {name: f"{array}[{i}]" for i, name in enumerate(names)}
