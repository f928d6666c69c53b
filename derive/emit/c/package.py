"""C99: a header and a source a mechanism, and the header and the source that all of them share."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

from jinja2 import Environment

from derive.emit import language
from derive.emit.braced import harmless
from derive.emit.c.description import counts, in_words, inputs, tables
from derive.emit.c.every_branch import MOST_SLOTS, constants_of_branches, every_branch_lines
from derive.emit.c.every_branch import NAME as EVERY_BRANCH
from derive.emit.c.functions import FRAME, function_name, functions, rotation_function
from derive.emit.c.lanes import constants_of_lanes
from derive.emit.c.printer import comment, laid_out, list_of, member, number, page, text
from derive.emit.c.program import constants_read, function_lines, function_of, setup
from derive.emit.interface import arguments_of, read_by, search_of
from derive.emit.language import CONSTANTS, GENERATED, STATUSES, Part, environment, head_of, runtime
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.search.loop.find import ONWARD
from derive.kinematics.search.loop.twins import TWIN
from derive.kinematics.search.programs import START
from derive.report.reasons import NO_MEANING, reasons_of, reasons_of_rotation

name, title = "c", "C"
MOST_AXES, MOST_BRANCHES, MOST_GIVEN, MOST_ROWS, MOST_MARGINS = 24, 12, 96, 6, 64
bound = f"no C: its calls hold {MOST_AXES} axes and {MOST_BRANCHES} branches"
_WRITTEN = ("softkin_constants.h", "softkin_rotation.h")
"""The files beside the runtime that hold constants and a program."""
_TAKEN = frozenset(
    "softkin softkin_constants softkin_rotation batches lane_programs lanes machine machines assert complex ctype "
    "errno fenv float inttypes iso646 limits locale math setjmp signal stdalign stdarg stdatomic stdbool stddef "
    "stdint stdio stdlib stdnoreturn string tgmath threads time uchar wchar wctype".split()
)
"""Names that no machine may have: those of shared files, here or in the core of the Python package, and of headers."""


def part(kinematics: Kinematics) -> Part | None:
    """Header and source of one mechanism; None if it has more axes or branches than the calls hold."""
    return _written(kinematics) if _fits(kinematics) else None


@kept_by_identity(10)
def _written(kinematics: Kinematics) -> Part:
    """Header and source of a mechanism that fits; LinuxCNC and the core of the Python package use them as well."""
    module = module_name(kinematics.mechanism.name)
    known = _known(kinematics, module)
    texts = {end: page(_templates().get_template(f"mechanism.{end}.j2").render(known)) for end in ("c", "h")}
    return {
        "index": {"name": kinematics.mechanism.name, "module": module},
        "files": {f"{module}.{end}": one for end, one in texts.items()},
        "notes": list(inputs(kinematics).notes),
    }


def files(parts: Sequence[Part]) -> dict[str, str]:
    """All files: path → text."""
    found = dict(shared())
    for one in parts:
        found |= one["files"]
    return found


@cache
def shared() -> Mapping[str, str]:
    """The files that are the same for all mechanisms."""
    return runtime(name) | {path: page(_templates().get_template(f"{path}.j2").render()) for path in _WRITTEN}


def module_name(mechanism: str) -> str:
    """The name of the files of a mechanism, without their ends."""
    return language.module_name(mechanism, _TAKEN)


def _fits(kin: Kinematics) -> bool:
    given = () if kin.search_given is None else kin.search_given.outputs
    sizes = [(len(kin.mechanism.joints), MOST_AXES), (len(kin.branches), MOST_BRANCHES), (len(given), MOST_GIVEN)]
    sizes.append((len(kin.rows), MOST_ROWS))
    sizes += [(len(kin.margins), MOST_MARGINS)]
    return all(size <= most for size, most in sizes)


@cache
def _templates() -> Environment:
    templates = environment(name).overlay(variable_start_string="@{", variable_end_string="}@")
    templates.filters |= {"text": text}
    rotation = function_lines(rotation_function(), "", {}, reasons_of_rotation())
    templates.globals |= {
        "generated": GENERATED,
        "statuses": STATUSES,
        "rotation": laid_out(rotation),
        "constants": {name: _literal(value) for name, value in CONSTANTS.items()},
        "no_meaning": NO_MEANING,
        "most_axes": MOST_AXES,
        "most_branches": MOST_BRANCHES,
        "most_given": MOST_GIVEN,
        "most_rows": MOST_ROWS,
        "most_margins": MOST_MARGINS,
        "most_together": MOST_SLOTS,
    }
    return templates


def _literal(value: float | tuple[float, ...]) -> str:
    if isinstance(value, tuple):
        return list_of(map(number, value))
    return repr(value) if isinstance(value, int) else number(value)


def _known(kin: Kinematics, module: str) -> dict[str, Any]:
    """The values that the templates of header and source arrange."""
    found = functions(kin)
    read = {name for f in found for name in read_by(f.program) - f.entry.given} | constants_read(kin)
    read |= constants_of_branches(kin) | constants_of_lanes(kin)
    made = setup(kin, module, read, inputs(kin))
    stored = {name: f"k->{member(name)}" for name in made.constants}
    of_programs = [function_lines(f, f"{module}_machine", stored, reasons_of(kin)) for f in found]
    further = _further(kin, module, stored)
    more = [lines for _, lines in further.values()]
    programs = {f.key: f.name for f in found if f.key} | {key: function for key, (function, _) in further.items()}
    given = inputs(kin)
    return {
        "module": module,
        "guard": f"SOFTKIN_{module.upper()}_H",
        "upper": module.upper(),
        "head": [line.removeprefix("/* ").removeprefix(" * ").removesuffix(" */") for line in _head(kin)],
        "counts": counts(kin),
        "slots": 2 ** len(kin.branches),
        "parameters": [
            {"name": given.names[p.name], "meaning": harmless(_described(p.meaning, p.unit, in_words(p), p.default))}
            for p in kin.parameters
        ],
        "constants": _members(made.constants),
        "tables": laid_out(tables(kin, module)),
        "functions": [laid_out(lines) for lines in (*of_programs, *more, made.lines)],
        "programs": programs,
        "name": text(kin.mechanism.name),
        "summary": text(kin.mechanism.summary),
        "source": text(kin.mechanism.source),
        "reads_rotation": kin.reads_rotation,
        "starts_forward": kin.starts,
        "is_searched": kin.search_given is not None,
        "needs_reference": _needed(kin),
    }


def _described(meaning: str, unit: str, words: str, default: float | None) -> str:
    at_first = "must be given" if default is None else f"default {default:g}"
    return f"{meaning}{f' [{unit}]' if unit else ''}: {words}; {at_first}"


def _members(constants: dict[str, str] | Any) -> list[str]:
    """The members of the struct of a machine, some of a type a line."""
    lines = []
    for kind in ("double", "int", "bool"):
        names = [member(name) for name, own in constants.items() if own == kind]
        lines += [f"  {kind} {', '.join(names)};"] if names else []
    return laid_out(lines)


def _head(kin: Kinematics) -> list[str]:
    """The lines at the top of a header."""
    order = [b.name for b in kin.branches] + [f"turn of {j.name}" for j in kin.period_joints]
    further = [f"configuration: {', '.join(order)}"] if order else []
    further.append(f"rows of the Jacobian: {', '.join(kin.rows) or 'none'}")
    texts = head_of(kin, map(inputs(kin).reworded, kin.mechanism.all_notes), further)
    return [line for text in texts for line in comment(text) or [""]]


def _needed(kin: Kinematics) -> str:
    """The reason why an inverse without a reference is refused."""
    held = [joint.name for joint in kin.mechanism.held_joints]
    return text(f"a reference is needed: it holds the value of {' and '.join(held)}") if held else "NULL"


def _further(kin: Kinematics, module: str, stored: dict[str, str]) -> dict[str, tuple[str, list[str]]]:
    """Further functions of machines that have them, by their keys: name and lines."""
    found = {}
    if lines := every_branch_lines(kin, f"{module}_machine", stored, reasons_of(kin)):
        found["every_branch"] = (EVERY_BRANCH, lines)
    if kin.starts:
        found |= _starts(f"{module}_machine", stored)
    if kin.search_given is not None:
        found["every_root"] = ("find_every_root", _every_root(kin))
    if any(joint.is_geared for joint in kin.period_joints):
        sizes = [number(float(j.turns)) if j.turns.is_number else stored[str(j.turns)] for j in kin.period_joints]
        inner = [f"sizes[{i}] = {size};" for i, size in enumerate(sizes)]
        inner = [f"const {module}_machine *k = machine;", *inner] if re.search(r"\bk->", " ".join(inner)) else inner
        summary = "Turns of the joint per turn of each axis whose turns are named."
        lines = function_of(summary, "static void find_turn_sizes(const void *machine, double *sizes)", inner)
        found["turn_sizes"] = ("find_turn_sizes", lines)
    return found


def _starts(machine: str, stored: dict[str, str]) -> dict[str, tuple[str, list[str]]]:
    """The functions of a machine whose forward kinematics starts where a caller says."""
    given = "const void *machine, {}const softkin_frame *start, {}"
    places = {f"start_{name}": f"start{place.removeprefix('frame')}" for name, place in FRAME.items()}
    written = [f"{text} = {places[name]};" for name, text in stored.items() if name in places]
    head = f"static void start_at({given.format('', 'void *moved')})"
    moved = [f"{machine} *k = moved;", f"*k = *(const {machine} *)machine;", *written]
    results = "softkin_frame *frame, double *margins, softkin_refusal *why"
    begun = f"static softkin_status find_forward_from({given.format('const double *axes, ', results)})"
    inner = [
        f"{machine} moved;", "start_at(machine, start, &moved);",
        "return find_forward(&moved, axes, frame, margins, why);",
    ]  # fmt: skip
    return {
        "start_at": ("start_at", function_of("The machine with another start of forward kinematics.", head, moved)),
        "forward_from": ("find_forward_from", function_of("Forward kinematics from a given start.", begun, inner)),
    }


def _every_root(kin: Kinematics) -> list[str]:
    """The function that finds all roots of a search; its arguments are those of the search itself."""
    program = search_of(kin)
    given = arguments_of(program, kin)
    places = f"{len(given)}, {given.index(START.name)}, {given.index(ONWARD.name)}, {len(kin.mechanism.joints)}"
    places += f", {'true' if any(o.name == TWIN for o in program.outputs) else 'false'}"
    head = "const void *machine, const double *given, softkin_take take, void *context"
    inner = [
        f"const softkin_roots of = {{{function_name(program)}_of, machine, given, {places}}};",
        "softkin_every_root(&of, take, context);",
    ]
    call = f"return {function_name(program)}(machine, given, results, why);"
    asked = "const void *machine, const double *given, double *results, softkin_refusal *why"
    own = function_of("", f"static softkin_status {function_name(program)}_of({asked})", [call])
    summary = "The joints at every root of the search, the nearest to the reference first."
    return [*own, "", *function_of(summary, f"static void find_every_root({head})", inner)]
