"""All branches of the inverse in one straight line: three functions of plain numbers, and one program on arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.emit.python.layout import fold, repeated, tuple_of
from derive.emit.python.methods import POSITION, ROTATION, branch
from derive.emit.python.printer import ArrayPrinter, ScalarPrinter, primitives_in, spelled
from derive.emit.python.program import (
    Argument,
    Method,
    array_statements,
    constants_of,
    item_lines,
    let_lines,
    unpacked,
    without_conversions,
)
from derive.emit.python.refusal import Refusals
from derive.ir.passes import untold
from derive.ir.program import (
    Let,
    Program,
    Status,
)
from derive.ir.symbols import (
    count,
    symbols_of,
)
from derive.ir.tree import Item
from derive.kinematics.kinematics import Kinematics
from derive.lowering.lower import lowered
from derive.lowering.scheduling import scheduled, spared
from derive.optimize.angle_addition import angles_first
from derive.optimize.coalesce import reused_names
from derive.optimize.guards import guarded
from derive.optimize.inline import squares_where_read, written_where_read
from derive.optimize.known_projection import aimed
from derive.optimize.negation import without_minus
from derive.optimize.rotation_identities import shorter_columns
from derive.optimize.symmetry import with_twins
from derive.optimize.unroll import (
    REFUSAL,
    Sign,
    choices,
    is_straight,
    specialised,
    suffixed,
    unroll,
    with_limits,
)
from derive.optimize.without_periods import any_turn
from derive.solver.folds import far_from_folds

NO_OFFSETS = "no_offsets"
"""Whether all axes have their zero where the joints have it: then nothing is added to them."""
_ARRAY = ArrayPrinter()
_SCALAR, _DIRECTIONS = ScalarPrinter(), ScalarPrinter(modulo_turns=True, is_trusted=True)
_FRAME = Argument("frame", "PlainFrame", (POSITION, ROTATION))


@dataclass(frozen=True)
class Function:
    """A function of the module: its head, what it says of itself, its statements."""

    head: list[str]
    summary: str
    body: list[str]


@dataclass(frozen=True)
class Unrolled:
    """What the templates need: the functions, the constants that they read, the primitives that they call."""

    functions: tuple[Function, ...]
    constants: list[str]
    parts: list[str]
    """The statements that compute what depends on constants alone."""
    primitives: list[str]


def can_be_unrolled(kin: Kinematics) -> bool:
    """Whether the inverse is a straight line for every branch."""
    return is_straight(kin.branch) and is_straight(kin.limits)


def signs(kin: Kinematics) -> tuple[Sign, ...]:
    """The branch signs, with the names of the two branches."""
    return tuple(Sign(count(f"sigma_{b.name}"), b.names) for b in kin.branches)


def every_branch(kin: Kinematics) -> Program:
    """All branches, periods open, limits tested."""
    return with_twins(unroll(_nearest(kin, with_limits(kin.branch, kin.limits)), signs(kin)))


def branches(kin: Kinematics, one: Program) -> Program:
    """All branches, each axis in any turn. one: a single branch for input that is trusted."""
    return any_turn(with_twins(unroll(one, signs(kin))))


def array_method(kin: Kinematics) -> Method:
    """All branches on arrays, turns as commanded, limits not tested."""
    program = unroll(untold(kin.branch), signs(kin))
    arguments = tuple(a for a in branch(kin).arguments if a.name != "signs")
    return Method("every_branch", "Every slot: its axes and statuses.", program, arguments, "tuple[tuple[Reals, Codes], ...]", ())


def array_lines(kin: Kinematics, method: Method) -> list[str]:
    """Its body."""
    found = {o.name: o.value for o in method.program.outputs}
    lines = array_statements(method)
    refusals = [_ARRAY.whole(found[suffixed(REFUSAL, signs(kin), choice)]) for choice in choices(len(kin.branches))]
    values = {name: _ARRAY.print(value) for name, value in found.items() if not name.startswith(REFUSAL)}
    statuses = {refusal: f"status{refusal.removeprefix(REFUSAL)}" if refusal != "0" else "status" for refusal in refusals}
    lines += [f"{status} = refused(status, {refusal})" for refusal, status in statuses.items() if status != "status"]
    lines.append("return (")
    for choice, refusal in zip(choices(len(kin.branches)), refusals, strict=True):
        axes = tuple_of([values[suffixed(j.axis.name, signs(kin), choice)] for j in kin.mechanism.joints])
        lines += fold(f"({axes}, {statuses[refusal]}),", 4)
    return [*lines, ")"]


def _nearest(kin: Kinematics, program: Program) -> Program:
    """No turn is commanded; on plain numbers a sine costs little."""
    given = specialised(program, {j.turn: sp.Integer(0) for j in kin.period_joints})
    return without_minus(angles_first(aimed(given), _constants(kin)))


def _trusted(kin: Kinematics) -> Program:
    """One branch for input that is trusted, before its turns are let go."""
    return shorter_columns(_nearest(kin, kin.branch))


def _constants(kin: Kinematics) -> frozenset[str]:
    return frozenset(o.name for o in kin.setup.outputs)


def unrolled(kin: Kinematics) -> Unrolled:
    """The functions on plain numbers. Near a fold they have no answer, an empty tuple: one branch after the other has."""
    kin = replace(kin, branch=untold(far_from_folds(kin.derived_branch)), limits=untold(kin.limits))
    methods, parts = _shorter(kin, _methods(kin))
    known = (*kin.setup.lets(), *parts)
    functions = (_slots(kin, methods[0], known), _directions(kin, methods[1], known), _direction(kin, methods[2], known, parts))
    read = {c for m in methods for c in constants_of(m)} | {s.name for p in parts for s in symbols_of(p.value)}
    constants = sorted(read - {p.name.name for p in parts})
    lines = [line for part in parts for line in let_lines(part, _SCALAR)]
    if any(NO_OFFSETS in line for line in functions[2].body):
        offsets = [c for c in constants if c in {j.offset.name for j in kin.mechanism.joints}]
        lines += fold(f"{NO_OFFSETS} = not any(({', '.join(offsets)},))")
    primitives = primitives_in([*lines, *(line for f in functions for line in f.body)])
    return Unrolled(functions, [spelled(c) for c in constants], lines, primitives)


def _shorter(kin: Kinematics, methods: Sequence[Method]) -> tuple[list[Method], tuple[Let, ...]]:
    """The methods with fewer operations, and what they read that is computed from constants."""
    named = [replace(m.program, name=m.name) for m in methods]
    programs, parts = lowered(named, _constants(kin), any_turn=True, inverts=False)
    return [replace(m, program=squares_where_read(p)) for m, p in zip(methods, programs, strict=True)], parts


def _methods(kin: Kinematics) -> tuple[Method, Method, Method]:
    position, rotation, sign_values, _, reference = branch(kin).arguments
    optional = replace(reference, default=repeated("0.0", len(reference.shape)))
    one = _trusted(kin)
    single = any_turn(with_twins(one))
    return (
        Method(
            "every_branch", "Every slot: its axes, or the number of its status.", every_branch(kin),
            (position, rotation, reference), "tuple[Reals | int, ...]", (),
        ),
        Method(
            "branches", "Every slot, the axes in some turn, of input that is trusted.", branches(kin, one),
            (_FRAME, optional), "tuple[Reals | None, ...]", (),
        ),
        Method(
            "branch", "One branch, the axes in some turn, of input that is trusted.", single,
            (_FRAME, sign_values, optional), "Reals | None", (),
        ),
    )  # fmt: skip


def has_folds(kin: Kinematics) -> bool:
    """Whether the functions on plain numbers have no answer near a fold."""
    return can_be_unrolled(kin) and far_from_folds(kin.derived_branch) is not kin.derived_branch


def _refusals(answer: Callable[[Status], str]) -> Refusals:
    """As the answer says, and nothing near a fold."""
    return Refusals(lambda status: "()" if status is Status.OK else answer(status))


def _slots(kin: Kinematics, method: Method, known: Sequence[Let]) -> Function:
    """The checked function."""
    count = 2 ** len(kin.branches)
    refusals = _refusals(lambda status: repeated(f"{list(Status).index(status)}", count))
    written = _Written.of(method, known)
    return written.function(_every(kin, written, refusals, _SCALAR, lambda refusal: refusal))


def _directions(kin: Kinematics, method: Method, known: Sequence[Let]) -> Function:
    refusals = _refusals(lambda _: repeated("None", 2 ** len(kin.branches)))
    written = _Written.of(method, known)
    return written.function(_every(kin, written, refusals, _DIRECTIONS, lambda _: "None"))


def _direction(kin: Kinematics, method: Method, known: Sequence[Let], parts: Sequence[Let]) -> Function:
    """One branch; its return once more without the offsets, read by it or in its parts, where all of them are zero."""
    written = _Written.of(method, known)
    lines = item_lines(written.items, _refusals(lambda _: "None"), _DIRECTIONS)
    zero = {joint.offset: sp.Integer(0) for joint in kin.mechanism.joints}
    zero |= {let.name: value for let in parts for value in [let.value.xreplace(zero)] if value.is_number}
    values, without = list(written.values.values()), [value.xreplace(zero) for value in written.values.values()]
    if without != values:
        lines += [f"if {NO_OFFSETS}:", *fold(f"return {_texts(without)}", 4)]
    return written.function([*lines, *fold(f"return {_texts(values)}")])


def _texts(values: Iterable[sp.Expr]) -> str:
    return tuple_of([_DIRECTIONS.print(value) for value in values])


@dataclass(frozen=True)
class _Written:
    """A method as it is written down: with a name for what is read more than once."""

    method: Method
    items: tuple[Item, ...]
    values: Mapping[str, sp.Expr]
    """The outputs."""

    @classmethod
    def of(cls, method: Method, known: Sequence[Let]) -> _Written:
        """known: what the constants are that it reads."""
        method = replace(method, program=without_conversions(method.program))
        wanted = [o.value for o in method.program.outputs]
        items = spared(scheduled(guarded(method.program.body, known), wanted), wanted)
        items, values = written_where_read(items, wanted)
        return cls(method, items, {o.name: o.value.xreplace(dict(values)) for o in method.program.outputs})

    def function(self, body: list[str]) -> Function:
        """The function with this body."""
        method = self.method
        head = fold(f"def {method.name}({', '.join(a.declared for a in method.arguments)}) -> {method.kind}:", 4)
        return Function(head, method.summary, [*unpacked(method), *body])


def _every(
    kin: Kinematics, written: _Written, refusals: Refusals, printer: ScalarPrinter, refused: Callable[[str], str]
) -> list[str]:
    """Statements one branch after the other, and all slots."""
    items, shorter = reused_names(written.items, list(written.values.values()), signs(kin))
    values = {name: value.xreplace(dict(shorter)) for name, value in written.values.items()}
    return [*item_lines(items, refusals, printer), *_returned(kin, values, refused)]


def _returned(kin: Kinematics, values: Mapping[str, sp.Expr], refused: Callable[[str], str]) -> list[str]:
    """The axes of every slot, or what stands for its refusal."""
    lines = ["return ("]
    for choice in choices(len(kin.branches)):
        refusal = values[suffixed(REFUSAL, signs(kin), choice)]
        axes = tuple_of([_DIRECTIONS.print(values[suffixed(j.axis.name, signs(kin), choice)]) for j in kin.mechanism.joints])
        text = axes
        if refusal != 0:
            text = f"{axes} if {_SCALAR.whole(refusal)} == 0 else {refused(_SCALAR.whole(refusal))}"
        lines += fold(f"({text})," if refusal != 0 else f"{text},", 4)
    return [*lines, ")"]

