"""JavaScript: an ES module a mechanism, and the modules of the runtime that all of them import."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import cache
from textwrap import wrap
from typing import Any

from jinja2 import Environment

from derive.drawing.parts import Parts, parts_of
from derive.drawing.pose import drawn_pose, nominal_machine
from derive.emit import language
from derive.emit.braced import block
from derive.emit.interface import arguments_of, read_by, search_of
from derive.emit.javascript.description import description, inputs
from derive.emit.javascript.functions import functions, rotation_function
from derive.emit.javascript.printer import PRINTER, RUNTIME, comment, function_name, laid_out, list_of, text
from derive.emit.javascript.program import function_lines, refusals_of, setup_lines
from derive.emit.language import CONSTANTS, GENERATED, OF_POSES, STATUSES, Part, environment, head_of, runtime
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import TIE_OF_LENGTHS, chooses_by_lengths
from derive.kinematics.search.loop.find import ONWARD
from derive.kinematics.search.programs import START
from derive.report.reasons import reasons_of, reasons_of_rotation

name, title, bound = "javascript", "JavaScript", ""
_VERSION = "0.1.0"
_AROUND = ("index.js", "package.json")
_WRITTEN = ("softkin/constants.js", "softkin/rotation.js")
"""The files beside the runtime that hold constants and a program."""
_TEXT = 90
"""The largest number of columns of a text; a longer one is written as a sum."""


def part(kinematics: Kinematics) -> Part:
    """The module of one mechanism, and its entry in the list."""
    module = module_name(kinematics.mechanism.name)
    entry = {"name": kinematics.mechanism.name, "module": module}
    given = inputs(kinematics)
    return {
        "index": entry,
        "files": {f"{module}.js": _module(kinematics, module)},
        "notes": list(given.notes),
        "inputs": dict(given.names),
    }


def files(parts: Sequence[Part]) -> dict[str, str]:
    """All files: path → text."""
    index = sorted((part["index"] for part in parts), key=lambda entry: str(entry["module"]))
    known = {"index": index}
    found = runtime(name)
    found |= {path: _templates().get_template(f"{path}.j2").render(known) for path in (*_AROUND, *_WRITTEN)}
    for one in parts:
        found |= one["files"]
    return found


def module_name(mechanism: str) -> str:
    """The name of the module of a mechanism; that of the index is taken."""
    return language.module_name(mechanism, ("index",))


@cache
def _templates() -> Environment:
    templates = environment(name).overlay(variable_start_string="<<", variable_end_string=">>")
    templates.filters |= {"text": text}
    templates.globals |= {
        "generated": GENERATED,
        "version": _VERSION,
        "statuses": STATUSES,
        "rotation": laid_out(function_lines(rotation_function(), refusals_of(reasons_of_rotation()))),
        "constants": {name: _literal(value) for name, value in {**CONSTANTS, **OF_POSES}.items()},
    }
    return templates


def _literal(value: float | tuple[float, ...]) -> str:
    return list_of(map(_literal, value)) if isinstance(value, tuple) else PRINTER.number(value)


def _module(kin: Kinematics, module: str) -> str:
    parts = _parts(kin)
    found, refusals = functions(kin, parts), refusals_of(reasons_of(kin))
    further, entries = _further(kin)
    read = {name for f in found for name in read_by(f.program) - f.entry.given}
    read |= set(re.findall(r"k\.(\w+)", " ".join(entries)))
    setup = setup_lines(kin, read, inputs(kin))
    programs = [f"{f.key}: {f.name}," for f in found if f.key]
    texts = [laid_out(lines) for lines in (setup, *(function_lines(f, refusals) for f in found), *further)]
    stated = description(kin, module) | {"drawn": _drawn(kin), "parts": None if parts is None else parts.shape}
    return _templates().get_template("mechanism.js.j2").render(
        head=[line.removeprefix("// ") for line in _head(kin)],
        imports=_imports([line for lines in texts for line in lines]),
        description="\n".join(laid_out(_data(stated).split("\n"))),
        functions=texts,
        programs=["constants: findConstants,", *programs, *entries],
        parameters=[line.removeprefix("// ") for p in stated["parameters"] for line in _parameter(p)],
    )  # fmt: skip


def _parts(kin: Kinematics) -> Parts | None:
    """The drawn parts of the machine; None if nothing can be drawn."""
    try:
        return parts_of(kin)
    except Exception:  # whatever a drawing meets, the formulas are proven without it
        return None


def _drawn(kin: Kinematics) -> list[float] | None:
    """The axis values of the pose that a picture shows, with nominal parameters; None if there is none."""
    try:
        return list(map(float, drawn_pose(nominal_machine(kin)).axes))
    except Exception:  # as above
        return None


def _head(kin: Kinematics) -> list[str]:
    """The lines at the top of a module."""
    texts = head_of(kin, map(inputs(kin).reworded, kin.mechanism.all_notes))
    return [line for text in texts for line in comment(text) or [""]]


def _parameter(p: Mapping[str, Any]) -> list[str]:
    default = "" if p["default"] is None else f"; default {PRINTER.number(float(p['default']))}"
    unit = f" [{p['unit']}]" if p["unit"] else ""
    return comment(f"{p['name']}: {p['meaning']}{unit}{default}")


def _further(kin: Kinematics) -> tuple[list[list[str]], list[str]]:
    """Further functions, and entries among the programs, of machines that have them."""
    lines: list[list[str]] = []
    entries: list[str] = []
    if kin.search_given is not None:
        lines.append(_all_joints(kin))
        entries.append("allJoints: findAllJoints,")
        if kin.mechanism.search is not None and kin.mechanism.search.where is not None:
            entries.append("isSearched: (k) => k.searched,")
    if chooses_by_lengths(kin.mechanism):
        entries.append(f"tie: (k) => k.{TIE_OF_LENGTHS.name},")
    if any(joint.is_geared for joint in kin.period_joints):
        sizes = [PRINTER.number(float(j.turns)) if j.turns.is_number else f"k.{j.turns}" for j in kin.period_joints]
        entries.append(f"turnSizes: (k) => {list_of(sizes)},")
    return lines, entries


def _all_joints(kin: Kinematics) -> list[str]:
    """The function that finds all roots of a search; its arguments are those of the search itself."""
    program = search_of(kin)
    given = arguments_of(program, kin)
    places = f"{given.index(START.name)}, {given.index(ONWARD.name)}, {len(kin.mechanism.joints)}"
    body = block(
        "function findAllJoints(k, given)", [f"return everyRoot({function_name(program.name)}, k, given, {places});"]
    )
    return ["/** The joints at every root of the search, the nearest to the reference first. */", *body]


def _imports(lines: Sequence[str]) -> list[str]:
    """The names of the runtime that the functions use."""
    words = {word for line in lines for word in re.findall(r"[A-Za-z_]\w*", line.partition("// ")[0])}
    wanted = [n for n in (*RUNTIME, "refuseParameters") if n in words]
    return laid_out_list(sorted({*wanted, "createMachine", "freeze"}))


def laid_out_list(words: Sequence[str]) -> list[str]:
    """Words with commas, as many as fit in a line."""
    lines = [""]
    for word in words:
        if len(lines[-1]) + len(word) > 110:
            lines.append("")
        lines[-1] += f"{' ' if lines[-1] else ''}{word},"
    return lines


def _data(value: dict[str, Any]) -> str:
    """Plain data, an entry a line."""
    return "{\n" + "".join(f"  {key}: {_entry(part)},\n" for key, part in value.items()) + "}"


def _entry(value: Any) -> str:
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return "[\n" + "".join(f"    {_flat(one)},\n" for one in value) + "  ]"
    return _flat(value)


def _flat(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key}: {_flat(one)}" for key, one in value.items()) + " }"
    if isinstance(value, list):
        return list_of(map(_flat, value))
    if isinstance(value, float):
        return PRINTER.number(value)
    if isinstance(value, str):
        return " + ".join(map(text, wrap(value, _TEXT, drop_whitespace=False))) or text(value)
    return text(value)
