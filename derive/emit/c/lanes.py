"""Several poses at a time in C: one loop over lanes without a branch, which compilers turn into vector instructions.

It solves regular poses, on one branch and with automatic turns. It marks any other lane, and that pose is then solved
by itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from derive.description.mechanism import Joint
from derive.emit.braced import block
from derive.emit.c.every_branch import straight_line
from derive.emit.c.printer import C, comment, commented, member, spelled, type_of
from derive.emit.c.program import function_of
from derive.emit.every_branch import constants, given_to_branch, known_constants, read_of, signs
from derive.emit.interface import read_by
from derive.equations.rotation_repair import surely_exact
from derive.ir.program import Let, Program, Require
from derive.ir.symbols import COORDINATE_NAMES, REFUSAL, ROTATION_ENTRIES, branch_sign, choices, suffixed, symbols_of
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.lost_digits.doubts import without_meeting
from derive.lowering.passes import ANY_TURN, LANES, REGULAR, SPECIALISED, Given, applied, lowered

ONE, EVERY = "regular", "regular_all"
"""The ends of the names of the functions: for the branch that the signs choose, and for all branches."""
_SUMMARIES = {
    ONE: "The axes of each lane on its branch; where it misses anything, they mean nothing.",
    EVERY: "The status and the axes of every slot of each lane; where it misses anything, they mean nothing.",
}
_RESULTS = {ONE: ("axes", "near"), EVERY: ("statuses", "axes", "near")}
"""The tables that are written, for each number all lanes: axes, and the value next to which each turn is chosen."""
_GIVEN = "const softkin_lanes *given"
_LOOP = "for (int lane = 0; lane < SOFTKIN_LANES; lane += 1)"


@dataclass(frozen=True)
class InLanes:
    """A program for regular poses, in which an axis may be on any turn, and the bindings of its constants."""

    program: Program
    parts: tuple[Let, ...]

    @property
    def name(self) -> str:
        """The name of its function, behind that of the machine."""
        return self.program.name


@kept_by_identity(10)
def in_lanes(kin: Kinematics) -> tuple[InLanes, ...]:
    """The programs of a machine. None if they would need more than arithmetic, roots and angles, if a turn moves
    several axes or a gear, or if nothing moves. That of all branches only if these are few.
    """
    if not kin.mechanism.joints or any(joint.coupling != 0 or joint.is_geared for joint in kin.period_joints):
        return ()
    given = given_to_branch(kin)
    found = REGULAR.change(applied((*SPECIALISED, *ANY_TURN), without_meeting(kin.branch), given), given)
    if found is None:
        return ()
    own = InLanes(replace(found, name=ONE), ())
    every = _every_branch(kin, found)
    return (own,) if every is None else (own, every)


def _every_branch(kin: Kinematics, one: Program) -> InLanes | None:
    """The program of all branches; None if there is no straight line. one: that of one branch."""
    line = straight_line(kin)
    if line is None:
        return None
    parts = line.parts
    found = REGULAR.change(line.program, Given(constants(kin) | {part.name.name for part in parts}))
    if found is None:  # it takes sines of sums of angles, which lanes lack and one branch does not need
        (found,), parts = lowered(
            [replace(one, name=EVERY)], constants(kin), LANES, branches={EVERY: signs(kin)}, known=known_constants(kin)
        )
    return InLanes(replace(found, name=EVERY), read_of(parts, found))


def constants_of_lanes(kin: Kinematics) -> set[str]:
    """The constants of the machine that these programs read."""
    return {name for found in in_lanes(kin) for name in _types(kin, found)}


def lanes_lines(kin: Kinematics, module: str, found: InLanes) -> list[str]:
    """The function of one of these programs."""
    printer, places = _Lanes(), _places(kin)
    program = found.program
    turned = {joint.reference.name for joint in kin.period_joints}
    read = read_by(program) | {s.name for part in found.parts for s in symbols_of(part.value)} | turned
    lane = [
        *_taken(places, read),
        "double missed = misses[lane];",
        *_statements(program, printer),
        *(f"near[{i}][lane] = {_near(joint)};" for i, joint in enumerate(kin.period_joints)),
        *_results(kin, found, printer),
        "misses[lane] = missed;",
    ]
    constant = _constants(kin, found)
    inner = [
        *([f"const {module}_machine *k = machine;"] if constant else []),
        *constant,
        *(line for part in found.parts for line in _let(part, printer)),
        *block(_LOOP, lane),
    ]
    results = ", ".join(f"double (*SOFTKIN_RESTRICT {word})[SOFTKIN_LANES]" for word in _RESULTS[found.name])
    head = f"void {module}_{found.name}(const void *machine, {_GIVEN}, {results}, double *SOFTKIN_RESTRICT misses)"
    return function_of(_SUMMARIES[found.name], head, inner)


def rotation_lines() -> list[str]:
    """The lines that test whether each lane has an exact rotation; what is missing is added to the sum."""
    printer = _Lanes()
    places = {r.name: f"given->rotation[{i}][lane]" for i, r in enumerate(ROTATION_ENTRIES)}
    lane = [
        *_taken(places, set(places)),
        "double missed = misses[lane];",
        *(_missing(condition, printer) for condition in surely_exact()),
        "misses[lane] = missed;",
    ]
    head = f"static inline void softkin_lanes_inexact({_GIVEN}, double *SOFTKIN_RESTRICT misses)"
    return function_of("Lanes miss where the rotation is not exact.", head, block(_LOOP, lane))


def _places(kin: Kinematics) -> dict[str, str]:
    """The values that differ from lane to lane, each with its place."""
    position = {name: f"given->position[{i}][lane]" for i, name in enumerate(COORDINATE_NAMES)}
    rotation = {r.name: f"given->rotation[{i}][lane]" for i, r in enumerate(ROTATION_ENTRIES)}
    own = {branch_sign(b.name).name: f"given->signs[{i}][lane]" for i, b in enumerate(kin.branches)}
    reference = {j.reference.name: f"given->reference[{i}][lane]" for i, j in enumerate(kin.mechanism.joints)}
    return position | rotation | own | reference


def _taken(places: dict[str, str], read: set[str]) -> list[str]:
    """A variable of the lane for each number that is read, signs among them."""
    own = [f"{spelled(name)} = {place}" for name, place in places.items() if name in read]
    return [f"const double {', '.join(own)};"] if own else []


def _types(kin: Kinematics, found: InLanes) -> dict[str, str]:
    """The constants of the machine that a program reads, and the types of these."""
    types = {s.name: type_of(s) for part in found.parts for s in symbols_of(part.value)}
    types |= {s.name: type_of(s) for s in found.program.inputs}
    types |= {f"mid_{joint.key}": "double" for joint in kin.period_joints}
    types |= {f"single_{joint.key}": "bool" for joint in kin.period_joints}
    given = _places(kin).keys() | {part.name.name for part in found.parts}
    return {name: types[name] for name in sorted(types.keys() - given)}


def _constants(kin: Kinematics, found: InLanes) -> list[str]:
    """The constants of the machine in local variables, which writing to the lanes cannot change."""
    own = []
    for name, kind in _types(kin, found).items():
        value = f"k->{member(name)}"
        own.append(f"{spelled(name)} = {f'{value} ? 1.0 : 0.0' if kind == 'bool' else value}")
    return [f"const double {', '.join(own)};"] if own else []


def _near(joint: Joint) -> str:
    """The value next to which the turn of an axis is chosen: the reference, or the middle of narrow limits."""
    return f"{spelled(f'single_{joint.key}')} > 0.0 ? {spelled(f'mid_{joint.key}')} : {spelled(joint.reference.name)}"


def _statements(program: Program, printer: C) -> Iterator[str]:
    asked = set[sp.Basic]()
    for statement in program.body:
        if isinstance(statement, Let):
            yield from _let(statement, printer)
        elif isinstance(statement, Require):
            new = [part for part in sp.And.make_args(statement.condition) if part not in asked]
            asked.update(new)
            if new:
                yield from comment(statement.comment)
            for part in sorted(new, key=sp.default_sort_key):
                yield _missing(part, printer)


def _missing(condition: sp.Basic, printer: C) -> str:
    """A number, not a flag: it is as wide as all others in the loop."""
    return f"missed += {printer.print(condition)} ? 0.0 : 1.0;"


def _let(let: Let, printer: C) -> Sequence[str]:
    value = printer.whole_value(let.name, let.value)
    kind = "bool" if type_of(let.name) == "bool" else "double"
    return commented(f"const {kind} {spelled(let.name.name)} = {value};", let.comment)


def _results(kin: Kinematics, found: InLanes, printer: C) -> Iterator[str]:
    """The lines that write the status and the axes of every slot."""
    values = {o.name: o.value for o in found.program.outputs}
    joints = kin.mechanism.joints
    if found.name == ONE:
        yield from (f"axes[{i}][lane] = {printer.print(values[j.axis.name])};" for i, j in enumerate(joints))
        return
    own = signs(kin)
    for slot, choice in enumerate(choices(len(own))):
        yield f"statuses[{slot}][lane] = {printer.print(values[suffixed(REFUSAL, own, choice)])};"
        for place, joint in enumerate(joints, slot * len(joints)):
            yield f"axes[{place}][lane] = {printer.print(values[suffixed(joint.axis.name, own, choice)])};"


class _Lanes(C):
    """Expressions without a branch: choices are computed, not decided by calls."""

    functions = {
        **C.functions,
        "root": "softkin_lane_root", "atan2": "softkin_lane_angle", "nearest_period": "softkin_lane_turn",
    }  # fmt: skip
    square_root = ""
