"""The modules of one mechanism: its class, its programs on arrays, and its branches in a straight line."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

from derive.drawing.parts import lines_of
from derive.emit import native
from derive.emit.every_branch import can_be_unrolled, has_doubts, is_unrolled
from derive.emit.interface import arguments_of, search_of
from derive.emit.python import entries, setup
from derive.emit.python.arrays import CALLED, TYPES, array_body, named_in, values_of_a_row
from derive.emit.python.calls import every_root
from derive.emit.python.methods import array_methods, drawn_loop, methods, rows_of_twist
from derive.emit.python.printer import primitives_in
from derive.emit.python.program import Method, constants_of, scalar_body
from derive.emit.python.refusal import explained
from derive.emit.python.runtime import templates
from derive.emit.python.straight_line import Function, Unrolled, is_trusted, trusted_branch, unrolled
from derive.ir.passes import without_reasons
from derive.ir.program import Iterate
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import TIE_OF_LENGTHS, chooses_by_lengths
from derive.report.reasons import reasons_of

_MADE = ("Axis", "ConfigurationByte", "Diagnosis", "Parameter", "Status")
"""The types of which a module creates values; it names all other types in annotations alone."""


def index(kin: Kinematics) -> dict[str, Any]:
    """The entry of a mechanism in the lists of the package."""
    mechanism = kin.mechanism
    return {
        "name": mechanism.name,
        "class_name": entries.class_name(mechanism.name, mechanism.class_name),
        "module": entries.module_name(mechanism.name),
        "summary": mechanism.summary,
        "example": entries.example(kin),
        "key": native.key(kin),
        "lanes": native.in_lanes(kin),
    }


def modules(kin: Kinematics) -> dict[str, str]:
    """The files of a mechanism: path → text."""
    names = index(kin)
    arrays = [_without_reasons(m) for m in array_methods(kin)]
    straight_line = unrolled(kin) if is_unrolled(kin) else None
    contexts = {
        "": ("mechanism.py.j2", _class_context(kin, arrays, straight_line)),
        "_array_programs/": ("arrays.py.j2", _array_context(kin, arrays)),
        "_unrolled/": ("unrolled.py.j2", {"unrolled": straight_line}),
    }
    return {
        f"softkin/{folder}{names['module']}.py": templates().get_template(template).render(names | context)
        for folder, (template, context) in contexts.items()
        if straight_line or folder != "_unrolled/"
    }


def _class_context(kin: Kinematics, arrays: Sequence[Method], straight_line: Unrolled | None) -> dict[str, Any]:
    """The values that the template of the class reads; `lean` are its branches in a straight line, if any."""
    scalar = methods(kin)
    reasons = explained(reasons_of(kin))
    bodies = [scalar_body(m, reasons) if m.is_explained else scalar_body(_without_reasons(m)) for m in scalar]
    trusted = trusted_branch(kin) if is_trusted(kin) else None
    setup_lines = setup.setup_body(kin, _constants_read(kin, (*scalar, *arrays), straight_line or trusted))
    types = _types(kin, scalar)
    chain = entries.chain(kin)
    return {
        "kin": kin,
        "mechanism": kin.mechanism,
        "entries": entries,
        "keywords": setup.keywords(kin),
        "attributes": setup.attributes(kin),
        "setup_body": setup_lines,
        "array_programs": _array_programs(kin),
        "bases": _bases(kin),
        "core_types": sorted({"Image", "Mechanism", "Pose"}),
        "types": [name for name in types if name in _MADE],
        "checked_types": [name for name in types if name not in _MADE],
        "lean": straight_line,
        "trusted": trusted,
        "slots": ("_all_trusted", "_constants", "_finish", "_one_trusted") if straight_line else ("_constants",),
        "of_configuration": [
            *(["Criterion"] if chooses_by_lengths(kin.mechanism) else []),
            *(["period"] if entries.turn_sizes(kin) else []),
        ],
        "chooses_by_lengths": chooses_by_lengths(kin.mechanism),
        "has_doubts": has_doubts(kin),
        "binds_in_loops": any(isinstance(s, Iterate) and s.otherwise is None for p in kin.shared for s in p.body),
        "margins": tuple(m.name for m in kin.margins),
        "every_root": _every_root(kin),
        "chain": chain,
        "lines": lines_of(loop.shape) if (loop := drawn_loop(kin)) else (),
        "methods": [
            {"head": _head(m, "_"), "summary": m.summary, "body": b} for m, b in zip(scalar, bodies, strict=True)
        ],
        **_called(kin, bodies, (*setup_lines, *chain, *(trusted.body if trusted else ()))),
    }


def _called(kin: Kinematics, bodies: Sequence[Sequence[str]], further: Sequence[str]) -> dict[str, Any]:
    """The functions of the package that the class calls, in its methods and in further lines."""
    lines = [line for body in bodies for line in body]
    return {
        "primitives": primitives_in((*lines, *further)),
        "of_limits": [n for n in ("beyond", "beyond_turn", "turn_inside") if any(f"{n}(" in line for line in lines)],
        "searches": kin.search_given is not None,
    }


def _array_context(kin: Kinematics, arrays: Sequence[Method]) -> dict[str, Any]:
    """The values that the template of the programs on arrays reads."""
    array_programs = _array_programs(kin)
    texts = [(_array_head(m), array_body(m)) for m in arrays]
    lines = [line for head, body in texts for line in (head, *body)]
    return {
        "array_programs": array_programs,
        "imports": in_order({array_programs} | named_in(lines, CALLED)),
        "types": in_order(named_in(lines, TYPES)),
        "values": values_of_a_row(kin),
        "rows_of_twist": rows_of_twist(kin),
        "methods": [
            {"head": head, "summary": m.summary, "body": body} for m, (head, body) in zip(arrays, texts, strict=True)
        ],
        "searches": kin.search_given is not None,
    }


def _constants_read(kin: Kinematics, programs: Iterable[Method], straight_line: Unrolled | Function | None) -> set[str]:
    """The constants that a program or the text around the programs reads."""
    found = {name for method in programs for name in constants_of(method)} | set(
        straight_line.constants if straight_line else ()
    )
    found |= {TIE_OF_LENGTHS.name} if chooses_by_lengths(kin.mechanism) else set()
    search = kin.mechanism.search
    return found | ({"searched"} if search is not None and search.where is not None else set())


def _array_programs(kin: Kinematics) -> str:
    """The base class of the programs on arrays, by the calls that the mechanism offers."""
    if kin.mechanism.is_orientation:
        return "OrientationPrograms"
    return "StartedPrograms" if kin.starts else "Programs"


def _bases(kin: Kinematics) -> dict[str, str]:
    """The modules and names of the base classes: they hold the calls that only some mechanisms offer."""
    found = {"_offset": "OffsetKinematics"} if kin.offset_branch is not None else {}
    found |= {"_orientation": "OrientationKinematics"} if kin.mechanism.is_orientation else {}
    found |= {"_search": "SearchedInverse"} if kin.mechanism.search is not None else {}
    found |= {"_start": "IterativeForward"} if kin.starts else {}
    found |= {"_twist": "TwistChoice"} if kin.chooses_twist else {}
    return found or {"_core": "Mechanism"}


def _types(kin: Kinematics, used: Sequence[Method]) -> list[str]:
    kinds = {m.kind for m in used if m.kind} | {a.kind for m in used for a in m.arguments}
    further = {"PlainFrame", "Reals", "Rotation", "Signs", "Vector"} if can_be_unrolled(kin) else set()
    further |= {"ConfigurationByte"} if kin.configuration_size else set()
    further |= {"Configuration"} if entries.turn_sizes(kin) else set()
    further |= {"Axis"} if kin.mechanism.joints else set()
    return in_order(kinds - {"Pose", "Image", "TotalImage"} | {"Diagnosis", "Parameter", "Reals", "Status"} | further)


def _without_reasons(method: Method) -> Method:
    """The method in the form that refuses with a status alone, without a reason."""
    return replace(method, program=without_reasons(method.program))


def _every_root(kin: Kinematics) -> list[str]:
    """The lines that find all roots; none where nothing is searched."""
    if kin.search_given is None:
        return []
    program = search_of(kin)
    return every_root(program, arguments_of(program, kin), len(kin.mechanism.joints))


def _head(method: Method, prefix: str) -> str:
    arguments = "".join(f", {a.name}: {a.kind}" for a in method.arguments)
    result = f"{method.kind} | Status" if method.kind else "Status"
    if method.is_explained:
        result = f"{method.kind} | Diagnosis" if method.kind else "Diagnosis | None"
    return f"def {prefix}{method.name}(self{arguments}) -> {result}:"


def _array_head(method: Method) -> str:
    arguments = "".join(f", {a.name}: {a.kind}" for a in method.arguments)
    if method.is_shared:
        return f"def {method.name}(self{arguments}, status: Codes) -> {method.kind}:"
    kind = "tuple[Vector, Rotation, Reals]" if method.kind == "Pose" else method.kind
    result = f"tuple[{kind}, Codes]" if kind else "Codes"
    return f"def {method.name}(self{arguments}) -> {result}:"


def in_order(found: set[str]) -> list[str]:
    """The names in alphabetical order: constants, then classes, then functions."""
    return sorted(found, key=lambda n: (not n.isupper(), n[0].islower(), n))
