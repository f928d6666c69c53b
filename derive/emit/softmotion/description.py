"""The comment of a function block: its description in reStructuredText, which the SoftMotion configurator shows."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import astuple, replace
from textwrap import wrap

import sympy as sp
from jinja2 import Environment

from derive.description.mechanism import Kind, Mechanism, Role
from derive.emit.picture.style import SHOWN
from derive.emit.softmotion.block import Block
from derive.emit.softmotion.inputs import inputs
from derive.emit.softmotion.pictures import CHOICES
from derive.emit.st.layout import WIDTH
from derive.emit.st.names import respelled
from derive.geometry.frames import Motion
from derive.geometry.pose import Screw, pose_of
from derive.ir.constants import COINCIDENT, EXACT_ROTATION, ONE_TURN, ROTATION
from derive.ir.program import Call, Status, shared
from derive.kinematics.kinematics import Called, Kinematics
from derive.report.call_cost import open_slots, worst_inverse
from derive.report.cost import Bound, Cost, Costs, costs_of
from derive.report.reasons import workspace

_WIDTH = 100
_MARKUP = re.compile(r"[\\*`|]|_(?!\w)|(?<!\w)_|(?<=:):|(?<!\S)([!-/:-@\[-`{-~])(?=\1{3,}(?!\S))")
"""What begins or ends markup inside a line, and a word that could underline a title."""
_BLOCK = re.compile(r"[^\w\s\\]|\w+[.)]\s")
"""The beginning of a text that could be an item, a directive, a field or a table."""
_NAMES_DIRECTION = re.compile(r"\b[XYZ]\b")
_MOTION = {Kind.ROTARY: "rotary, deg", Kind.LINEAR: "linear, u", Kind.HELICAL: "turns, deg; declared linear"}
_MOTION |= {Kind.GEARED: "geared, deg; declared linear", Kind.DRIVING: "turning motor, deg; declared linear"}
_PERIOD = "1 is -180 to 180 degrees, 2 the turn above, -1 the turn below, 0 automatic"
_GEARED = f"turns of its joint, behind the gear: {_PERIOD}"
_BRANCH = "0 automatic, 3 where both solutions coincide"
_READ = (
    f"A commanded rotation R may have few exact digits, as after conversion from REAL. Where R^T R differs from the "
    f"identity by more than {float(EXACT_ROTATION):g}, R is repaired (z, the direction of the tool, is kept); by more "
    f"than {float(ROTATION):g}, it is refused."
)
_NOT_READ = "The commanded rotation is not read."
_COST_HEAD = ("Method", "Additions", "Multiplications", "Divisions", "Square roots", "Sines")
_OPEN_TURN = (
    f"Without a commanded turn, an axis whose limits are at most {ONE_TURN} degrees apart takes its one value inside "
    "them, any other axis the value nearest to the reference. Diagnose gives the number of a turn that is inside the "
    "limits (iTurn)."
)
_BOUNDED = "The run time of every method is bounded: no loop is endless, and no method waits. "
_REENTRANT = "others are re-entrant: several tasks may call them at once."
_TASKS = {
    True: f"{_BOUNDED}Initialize and AxisSettings write variables of the block; all {_REENTRANT}",
    False: f"{_BOUNDED}Initialize alone writes variables of the block; all {_REENTRANT}",
}
"""A paragraph about all methods, by whether drives pass their limits to the block."""
_KINDS = {
    (True, False): "Position kinematics for a SoftMotion axis group. ",
    (False, True): "Orientation kinematics, to be combined with a position kinematics for a SoftMotion axis group. ",
    (False, False): "Kinematics for a SoftMotion axis group. ",
}
"""The sentences on couplings, by whether it is a position kinematics, and whether it is an orientation kinematics."""
_TRANSFORMATION = (
    "A user transformation of a PacDrive robot. Config has the bytes of a configuration; automatic ones are near the "
    "last answer of Direct and Inverse, which both keep: each robot has an instance of its own. "
)
_WITHOUT_LENGTH = (
    f"where an axis is not determined: within {float(COINCIDENT):g} of your unit of length. The machine has no "
    "length with which this distance could be compared, so the margin is 1 everywhere else, and IsSingularity gives "
    "no earlier warning"
)
_AUTOMATIC = (
    "Automatic branches, meant for point-to-point movements, take the solution nearest to the reference. Limits refuse "
    "and never choose another solution or turn."
)
_DRIVES = " The limits that SoftMotion passes (AxisSettings) narrow those of the block."


def description(kinematics: Kinematics, block: Block, picture: str, templates: Environment) -> str:
    """The description of a block, with references to its pictures."""
    names, further = inputs(kinematics).names, inputs(kinematics).notes
    mechanism = kinematics.mechanism
    kind = mechanism.is_position, mechanism.is_orientation
    source = _TRANSFORMATION if block.is_transformation else _KINDS[kind]
    source += f"Source of the geometry: {mechanism.source}." if mechanism.source else ""
    text = templates.get_template("description.rst.j2").render(
        mechanism=mechanism,
        picture=None if kinematics.undrawn else picture.format(name=block.name),
        choices=picture.format(name=f"{block.name}{CHOICES}") if kinematics.has_choices else None,
        shown=SHOWN,
        source="\n".join(_lines(source.rstrip())),
        summary="\n".join(_lines(kinematics.mechanism.summary)),
        rows=", ".join(kinematics.rows),
        axes=_table(("Axis", "Motion", "Meaning"), _axes(kinematics)),
        parameters=_lines(f"{_refused(kinematics)}The parameters are read by Initialize alone."),
        configuration=list(_configuration(kinematics, block)),
        singularities=list(_singularities(kinematics)),
        workspace=list(_workspace(kinematics)),
        costs=[*_costs(costs_of(kinematics), block), *_looped(kinematics, costs_of(kinematics))],
        tasks=_lines(_BOUNDED.rstrip() if block.is_transformation else _TASKS[block.has_settings]),
        notes=[line for note in mechanism.all_notes for line in _item(respelled(note, names))]
        + [line for note in further for line in _item(note)],
        verification=list(_verification(kinematics)),
    )
    return text.rstrip("\n")


def _axes(kinematics: Kinematics) -> Iterator[Sequence[str]]:
    directions = directions_at_zero(kinematics.mechanism)
    for joint in kinematics.mechanism.joints:
        about = "" if _NAMES_DIRECTION.search(joint.meaning) else directions.get(joint.name, "")
        yield joint.name, _MOTION[joint.kind], joint.meaning + (f", {about} in the zero pose" if about else "")


def _refused(kinematics: Kinematics) -> str:
    """The sentence that names the lengths that may not be 0, which is the value of an input that is not set."""
    names = inputs(kinematics).names
    given = (p for p in kinematics.parameters if p.default is None)
    lengths = [names[p.name] for p in given if p.role in (Role.LENGTH, Role.SIGNED_LENGTH)]
    return f"A length has no default: Initialize refuses 0 for {', '.join(lengths)}. " if lengths else ""


def _configuration(kinematics: Kinematics, block: Block) -> Iterator[str]:
    if not block.configuration_size:
        yield "None: every pose has one solution."
        return
    search = kinematics.mechanism.search
    for branch, described in zip(block.branches, kinematics.branches, strict=True):
        text = f"Byte {branch.byte}, {branch.name}: 1 {branch.first}, 2 {branch.second}, {_BRANCH}."
        if described.is_crossing and search is not None:
            rises = f"what the search along {search.joint.name} brings to zero rises or falls there"
            tells = "it is the sign of the determinant of the Jacobian" if search.is_eliminated else rises
            text += f" It tells solutions apart whose other bytes are equal: {tells}. "
            text += "Leave it automatic unless you need one of them."
        yield from _item(text)
    for turns in (_PERIOD, _GEARED):
        periods = [p for p in block.periods if bool(p.turns) == (turns is _GEARED)]
        if len(periods) == 1:
            yield from _item(f"Byte {periods[0].byte}, turn of {periods[0].axis} (signed): {turns}.")
        elif periods:
            numbers, axes = ", ".join(str(p.byte) for p in periods), ", ".join(p.axis for p in periods)
            yield from _item(f"Bytes {numbers}, turns of {axes} (signed): {turns}.")
    yield ""
    yield from _lines(f"{block.name}_Config sets a configuration, {block.name}_ReadConfig reads one. {_AUTOMATIC}")
    if block.periods:
        yield ""
        yield from _lines(_OPEN_TURN + (_DRIVES if block.has_settings else ""))


def _singularities(kinematics: Kinematics) -> Iterator[str]:
    if not kinematics.margins:
        yield "None."
    for margin in kinematics.margins:
        what = "where its margin, a number without a unit, is 0" if margin.length is None else _WITHOUT_LENGTH
        yield from _item(f"{margin.name} ({margin.kind}): {what}.")


def _workspace(kinematics: Kinematics) -> Iterator[str]:
    own = [quantity.meaning for quantity in kinematics.mechanism.limited]
    limits = " and of ".join(["the limits of the axes", *own]) if own else "the limits of the axes"
    bounds = workspace(kinematics)
    if not kinematics.mechanism.joints:
        yield "Every pose: there is no axis."
    elif not bounds:
        yield from _lines(f"Every position that {limits} allow.")
    else:
        why = "Diagnose says which of them, and by how much where that can be measured"
        yield from _lines(f"A pose inside {limits} is refused for these reasons only; {why}:")
        yield ""
    for bound in bounds:
        yield from _item(f"{bound}.")
    yield ""
    yield from _lines(_READ if kinematics.reads_rotation else _NOT_READ)


def _verification(kinematics: Kinematics) -> Iterator[str]:
    found = kinematics.evidence
    if found is None:
        yield "None."
        return
    text = (
        f"The formulas were derived from the closure equations and checked against them at {found.poses} poses: "
        f"residual {found.closure_residual:.0e}"
    )
    if (inverted := found.inverted) is not None:
        found_by = "found by multi-start root finding, and"
        text += (
            f", inverse after forward {inverted.round_trip:.0e}, Jacobian against automatic differentiation "
            f"{inverted.jacobian:.0e}; "
        )
        if inverted.solutions == 1:
            text += f"1 solution was {found_by} it is a solution of these formulas"
        else:
            text += f"{inverted.solutions} solutions were {found_by} each of them is a solution of these formulas"
    yield from _lines(f"{text}. {found.exact.sentence} The block was not run on a controller.")
    if inverted is not None and inverted.missed is not None:
        missed, total = inverted.missed
        text = (
            f"Of {total} solutions, most of them close to poses where branches meet, the root search missed {missed}."
        )
        yield from _lines(text)


def _looped(kinematics: Kinematics, costs: Costs) -> Iterator[str]:
    """The cost of a method with a loop: of calls with a solution, of calls without one, and in the worst case."""
    cases = () if kinematics.self_test is None else kinematics.self_test.cases
    ran = [c for c in cases if c.status is not Status.NOT_INITIALIZED]  # the block computes nothing for the others
    named = [c for c in ran if c.called is not Called.INVERSE or open_slots(c, kinematics) == 1]
    one_branch = "CartesianToAxes with every branch named" if kinematics.branches else "CartesianToAxes"
    programs = (
        ("AxesToCartesian", Called.FORWARD, kinematics.forward, costs.forward),
        (one_branch, Called.INVERSE, kinematics.branch, worst_inverse(kinematics)),
    )
    for method, called, program, worst in programs:
        usual = replace(program, body=tuple(s for s in program.body if not (isinstance(s, Call) and s.is_rare)))
        if not any(bound.program == p.name for bound in costs.bounds for p in (usual, *shared([usual]))):
            continue  # a loop in a rare case counts as the cost of a singular pose
        calls = [c for c in named if c.called is called]
        found = ([c.operations for c in calls if (c.status is Status.OK) == ok] for ok in (True, False))
        solved, vain = (f"at most {max(numbers)}" if numbers else "not measured" for numbers in found)
        yield from _item(
            f"{method}, all operations together: of the calls of the self-test {solved} with a solution, {vain} "
            f"without one; of any call at most {sum(worst.counts)}."
        )


def _costs(costs: Costs, block: Block) -> Iterator[str]:
    rows = [("AxesToCartesian", costs.forward), ("CartesianToAxes", costs.inverse)]
    if block.branches:
        rows[1:] = [("CartesianToAxes, one branch", costs.inverse)]
        rows.append((f"CartesianToAxes, all {block.slots} branches", costs.automatic))
    more = (
        ("In addition: check of an exact frame", costs.exact),
        ("In addition: repair of a frame", costs.repair),
        (f"In addition: {costs.corner}", costs.corners),
    )
    rows += [(what, cost) for what, cost in more if any(cost.counts)]
    yield from _table(_COST_HEAD, map(_cost_row, rows))
    if costs.bounds:
        yield ""
    for bound in costs.bounds:
        yield from _item(_bound(bound))


def _cost_row(row: tuple[str, Cost]) -> Sequence[str]:
    return row[0], *map(str, astuple(row[1]))


def _bound(bound: Bound) -> str:
    what = f"{bound.note[0].upper()}{bound.note[1:]}"
    return f"{what}: at most {bound.limit} passes, all of which are counted; it stops as soon as it has converged."


def _item(text: str) -> list[str]:
    return _lines(text, "- ", "  ")


def _lines(text: str, first: str = "", further: str = "") -> list[str]:
    """A text as the lines of a paragraph."""
    return wrap(literal(text), _WIDTH, initial_indent=first, subsequent_indent=further, break_long_words=False)


def literal(text: str) -> str:
    """A text in which reStructuredText finds no markup, and Structured Text no end of the comment around it."""
    found = _MARKUP.sub(r"\\\g<0>", text).replace("*)", "*\\ )")
    return f"\\{found}" if _BLOCK.match(found) else found


def _table(head: Sequence[str], rows: Iterator[Sequence[str]]) -> list[str]:
    """A simple table in reStructuredText. A long text in the last column continues on lines of this column alone."""
    cells = [[literal(cell) for cell in row] for row in (head, *rows)]
    widths = [max(len(row[column]) for row in cells) for column in range(len(head) - 1)]
    widths[0] += (sum(widths) + len(widths)) % 2  # the last column begins at an even place, as every indentation does
    last = WIDTH - sum(width + 1 for width in widths)
    lines = [
        " ".join([cell.ljust(width) for cell, width in zip(first, widths, strict=True)] + [text]).rstrip()
        for row in cells
        for number, text in enumerate(wrap(row[-1], last, break_long_words=False) or [""])
        for first in [row[:-1] if number == 0 else [""] * len(widths)]
    ]
    rule = " ".join("=" * width for width in [*widths, min(last, max(len(row[-1]) for row in cells))])
    return [rule, lines[0], rule, *lines[1:], rule]


_WORDS = {Motion.TURN: "about", Motion.SHIFT: "along"}


def directions_at_zero(mechanism: Mechanism) -> dict[str, str]:
    """The direction in which each joint of a chain moves in the zero pose, by its name.

    It lacks joints that move several parts of the chain, and those whose direction is none of the machine's axes.
    """
    if mechanism.chain is None:
        return {}
    at_zero = {joint.symbol: sp.Integer(0) for joint in mechanism.joints}
    found: dict[str, str] = {}
    for joint in mechanism.joints:
        screws = [s for s in pose_of(mechanism.chain).screws if joint.symbol in s.amount.free_symbols]
        if len(screws) == 1 and (axis := _axis(screws[0], joint.symbol, at_zero)) is not None:
            found[joint.name] = f"{_WORDS[screws[0].motion]} {axis}"
    return found


def _axis(screw: Screw, joint: sp.Symbol, at_zero: dict[sp.Symbol, sp.Integer]) -> str | None:
    sense = sp.sign(sp.diff(screw.amount, joint).subs(at_zero))
    direction = [sp.nsimplify(entry) for entry in screw.direction.subs(at_zero) * sense]
    places = [place for place, entry in enumerate(direction) if entry != 0]
    if len(places) != 1 or direction[places[0]] not in (1, -1):
        return None
    return ("-" if direction[places[0]] == -1 else "") + "XYZ"[places[0]]
