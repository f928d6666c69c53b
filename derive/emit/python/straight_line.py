"""All branches of the inverse in one straight line: two functions of plain numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import Joint
from derive.emit.every_branch import (
    StraightLines,
    can_be_unrolled,
    has_doubts,
    signs,
    straight_lines,
    trusted,
    without_doubts,
)
from derive.emit.interface import POSITION, ROTATION
from derive.emit.python.layout import assigned, repeated, tuple_of
from derive.emit.python.methods import named
from derive.emit.python.printer import ScalarPrinter, primitives_in, spelled
from derive.emit.python.program import Argument, Method, constant_lines, constants_of, item_lines, let_lines, unpacked
from derive.emit.python.refusal import Refusals, status_of
from derive.ir.passes import without_reasons
from derive.ir.program import Let, Program, Status
from derive.ir.symbols import REFUSAL, Sign, choices, replaced, suffixed, symbols_of
from derive.ir.tree import Item, Tree
from derive.kinematics.kinematics import Kinematics
from derive.lowering.passes import ANY_TURN, NOTHING, UNCONVERTED, WITHOUT_SQUARES, WRITTEN_SHORT, Given, applied
from derive.optimize.without_periods import turns_that_count

NO_OFFSETS = "no_offsets"
"""Whether all axes have their zero where the joints have it, so that no offset is added."""
_SCALAR, _DIRECTIONS = ScalarPrinter(), ScalarPrinter(modulo_turns=True, for_valid_input=True)
_FRAME = Argument("frame", "PlainFrame", (POSITION, ROTATION))
_REFUSED = "refused"
"""The value in place of a refusal, by the number of its status: None, unless a caller asks for the status."""
_WHERE_REFUSED = Argument(_REFUSED, "Sequence[Any] = NOTHING", ())


@dataclass(frozen=True)
class Unrolled:
    """The values for the templates: the functions, the constants that they read, the primitives that they call."""

    functions: tuple[Function, ...]
    taken: list[str]
    """The statements that read the constants into local names."""
    constants: list[str]
    parts: list[str]
    """The statements that compute values from constants alone."""
    primitives: list[str]

    @property
    def can_finish(self) -> bool:
        """Whether one of the functions chooses turns and tests limits."""
        return len(self.functions) > 2

    @property
    def of_turns(self) -> list[str]:
        """The names of the configuration that the last function reads."""
        names = ("FIRST_TURN", "SECOND_TURN", "UNREACHABLE")
        return [n for n in names if self.can_finish and any(n in line for line in self.functions[-1].body)]

    @property
    def names_status(self) -> bool:
        """Whether all branches may refuse alike."""
        return any("Status." in line for function in self.functions for line in function.body)


def is_trusted(kin: Kinematics) -> bool:
    """Whether its one branch has a function for trusted input that always answers."""
    return can_be_unrolled(kin) and not kin.branches and not has_doubts(kin)


def unrolled(kin: Kinematics) -> Unrolled:
    """The functions on plain numbers. If digits may be lost they have no answer and return an empty tuple: there the
    branches are solved one after the other.
    """
    lines_of, kin = straight_lines(kin), without_doubts(kin)
    methods, parts = _methods(kin, lines_of), lines_of.parts
    known = (*kin.setup.lets(), *parts)
    last = finish(kin, lines_of.trusted)
    functions = (_directions(kin, methods[0]), _direction(kin, methods[1], known), *((last,) if last else ()))
    read = {c for f in functions for c in f.constants} | {s.name for p in parts for s in symbols_of(p.value)}
    taken = sorted(read - {p.name.name for p in parts})
    lines = [line for part in parts for line in let_lines(part, _SCALAR)]
    if any(NO_OFFSETS in line for line in functions[1].body):
        offsets = [c for c in taken if c in {j.offset.name for j in kin.mechanism.joints}]
        lines.append(f"{NO_OFFSETS} = not any({tuple_of(offsets)})")
    primitives = primitives_in([*lines, *(line for f in functions for line in f.body)])
    return Unrolled(functions, assigned({spelled(c): f"k.{spelled(c)}" for c in taken}), taken, lines, primitives)


def trusted_branch(kin: Kinematics) -> Function:
    """The method for trusted input of a machine without branches that never loses digits."""
    kin = replace(kin, branch=without_reasons(kin.branch))
    method = _single(kin, applied(ANY_TURN, trusted(kin), NOTHING))
    written = _Written.of(method)
    values = list(written.values.values())
    lines = [*constant_lines(written.method), *item_lines(written.items, _refusals(lambda _: "None"), _DIRECTIONS)]
    return written.function([*lines, f"return {_texts(values)}"])


def _methods(kin: Kinematics, found: StraightLines) -> tuple[Method, Method]:
    text = "Every slot, the axes in some turn, of input that is trusted."
    every, one = (applied(WITHOUT_SQUARES, program, NOTHING) for program in (found.every, found.one))
    arguments = (_FRAME, _optional(kin), _WHERE_REFUSED)
    return Method("branches", text, every, arguments, "tuple[Any, ...]", ()), _single(kin, one)


def _single(kin: Kinematics, program: Program) -> Method:
    sign_values = next(a for a in named(kin)["branch"].arguments if a.name == "signs")
    text = "One branch, the axes in some turn, of input that is trusted."
    return Method("branch", text, program, (_FRAME, sign_values, _optional(kin)), "Reals | None", ())


def _optional(kin: Kinematics) -> Argument:
    """The reference, which may be left out: then no branch has axes where one of them is held at the reference."""
    reference, held = named(kin)["branch"].arguments[-1], kin.mechanism.held_joints
    values = ['float("nan")' if joint in held else "0.0" for joint in kin.mechanism.joints]
    return replace(reference, default=f"({', '.join(values)},)" if held else repeated("0.0", len(values)))


def _refusals(answer: Callable[[Status], str]) -> Refusals:
    """Refusals that return the given answer, and an empty tuple where digits may be lost."""
    return Refusals(lambda status: "()" if status is Status.OK else answer(status))


def _directions(kin: Kinematics, method: Method) -> Function:
    """All branches, statements one branch after the other."""
    count = 2 ** len(kin.branches)
    refusals = _refusals(lambda status: repeated(f"{_REFUSED}[{status_of(status)}]", count))
    written = _Written.of(method, signs(kin))
    lines = item_lines(written.items, refusals, _DIRECTIONS)
    return written.function([*lines, f"return {_slots(kin, written.values)}"])


def _direction(kin: Kinematics, method: Method, known: Sequence[Let]) -> Function:
    """One branch; if all offsets are zero, a second return statement leaves them out."""
    written = _Written.of(method)
    lines = item_lines(written.items, _refusals(lambda _: "None"), _DIRECTIONS)
    zero = {joint.offset: sp.Integer(0) for joint in kin.mechanism.joints}
    zero |= {let.name: value for let in known for value in [replaced(let.value, zero)] if value.is_number}
    values, without = list(written.values.values()), [replaced(value, zero) for value in written.values.values()]
    if without != values:
        lines += [f"if {NO_OFFSETS}:", f"    return {_texts(without)}"]
    return written.function([*lines, f"return {_texts(values)}"])


def _texts(values: Iterable[sp.Expr]) -> str:
    return tuple_of([_DIRECTIONS.print(value) for value in values])


@dataclass(frozen=True)
class _Written:
    """A method as it is written: with a name for every value that is read more than once."""

    method: Method
    items: tuple[Item, ...]
    values: Mapping[str, sp.Expr]
    """The outputs."""

    @classmethod
    def of(cls, method: Method, signs: Sequence[Sign] = ()) -> _Written:
        """signs: those of the branches that it holds."""
        method = replace(method, program=applied(UNCONVERTED, method.program, NOTHING))
        tree = applied(WRITTEN_SHORT, Tree.of(method.program), Given(signs=tuple(signs)))
        return cls(method, tree.items, {o.name: o.value for o in tree.program.outputs})

    def function(self, body: list[str]) -> Function:
        """The function with this body."""
        method, body = self.method, [*unpacked(self.method), *body]
        arguments = ", ".join(a.declared for a in method.arguments)
        return Function(method.name, arguments, method.kind, method.summary, body, constants_of(method))


def _slots(kin: Kinematics, values: Mapping[str, sp.Expr]) -> str:
    """The axes of every slot, or the value in place of its refusal."""
    slots = []
    for choice in choices(len(kin.branches)):
        refusal = values[suffixed(REFUSAL, signs(kin), choice)]
        axes = _texts(values[suffixed(j.axis.name, signs(kin), choice)] for j in kin.mechanism.joints)
        number = _SCALAR.whole(refusal)
        slots.append(axes if refusal == 0 else f"{axes} if {number} == 0 else {_REFUSED}[{number}]")
    return tuple_of(slots)


@dataclass(frozen=True)
class Function:
    """A function or a method: its name, arguments and result, its docstring, its statements."""

    name: str
    arguments: str
    kind: str
    summary: str
    body: list[str]
    constants: list[str]
    """The constants of the machine that it reads."""


def finish(kin: Kinematics, trusted: Program) -> Function | None:
    """The function that turns axes from trusted input into answers: it chooses turns and tests limits.

    trusted: one branch for such input. None if an axis value alone determines neither its turn nor its limits: with
    gear coupling the reference is compared joint by joint, and a limited quantity depends on several axes.
    """
    if kin.limited or any(joint.coupling != 0 or joint.is_geared for joint in kin.period_joints):
        return None
    joints = kin.mechanism.joints
    counted = {s.name for s in turns_that_count(trusted)}
    open_joints = [joint for joint in joints if joint.multi_turn and joint.axis.name not in counted]
    text = "Every slot of `branches` with the axes on their turns, or the number of its status; limits are tested."
    arguments = "found: tuple[Reals | int, ...], reference: Reals"
    body = [*_near(kin, open_joints), *_every_slot(joints, open_joints)]
    constants = [f"{word}_{joint.key}" for joint in open_joints for word in ("single", "mid")]
    constants += [f"{word}_{joint.key}" for joint in joints for word in ("lowest", "highest")]
    return Function("finish", arguments, "tuple[Reals | int, ...]", text, body, constants)


def _near(kin: Kinematics, open_joints: list[Joint]) -> list[str]:
    """The values next to which turns are chosen: the reference, or the middle of limits that hold one value."""
    if not open_joints:
        return []
    targets = [joint.reference.name if joint in open_joints else "_" for joint in kin.mechanism.joints]
    chosen = (f"near_{j.key} = mid_{j.key} if single_{j.key} else {j.reference.name}" for j in open_joints)
    return [f"{', '.join(targets)}{',' if len(targets) == 1 else ''} = reference", *chosen]


def _every_slot(joints: tuple[Joint, ...], open_joints: list[Joint]) -> list[str]:
    names = [joint.axis.name for joint in joints]
    turned: list[str] = []
    for joint in open_joints:
        axis, near = joint.axis.name, f"near_{joint.key}"
        turned += [
            f"if not FIRST_TURN <= {axis} - {near} < SECOND_TURN:",
            f"    {axis} = nearest_period({axis}, {near})",
        ]
    inside = " and ".join(f"lowest_{joint.key} <= {joint.axis.name} <= highest_{joint.key}" for joint in joints)
    every = [
        f"{', '.join(names)}{',' if len(names) == 1 else ''} = axes",
        *turned,
        f"if {inside}:",
        f"    axes = {tuple_of(names)}",
        "else:",
        "    axes = UNREACHABLE",
    ]
    return [
        "every: list[Reals | int] = []",
        "for axes in found:",
        "    if not isinstance(axes, int):",
        *(f"        {line}" for line in every),
        "    every.append(axes)",
        "return tuple(every)",
    ]
