"""Python: the package `softkin`, which has a runtime and one module for each mechanism."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from textwrap import wrap
from typing import Any

from jinja2 import Environment

from derive.description.dimensions import Role
from derive.emit.language import GENERATED, Part, environment
from derive.emit.python import entries, setup
from derive.emit.python.arrays import CALLED, OF_A_SEARCH, TYPES, array_body, named_in, values_of_a_row
from derive.emit.python.calls import every_root
from derive.emit.python.entries import inputs
from derive.emit.python.finish import Function
from derive.emit.python.layout import formatted
from derive.emit.python.methods import (
    branch,
    differential,
    end_point_shift,
    forwards,
    limits,
    methods,
    projection,
    shared,
)
from derive.emit.python.printer import ScalarPrinter, literal, primitives_in
from derive.emit.python.program import Method, constants_of, has_search, scalar_body, unpacked
from derive.emit.python.refusal import explained
from derive.emit.python.rotation import rotation_functions
from derive.emit.python.unrolled import (
    Unrolled,
    can_be_unrolled,
    has_folds,
    is_trusted,
    is_unrolled,
    trusted_branch,
    unrolled,
)
from derive.ir import cells, roots
from derive.ir.constants import (
    EDGE,
    EXACT_ROTATION,
    FINISHED,
    FREE_ANGLE,
    GEARED_TURN,
    HELD,
    LARGEST,
    LEAST,
    LIMIT,
    ONE_TURN,
    PIVOT,
    ROTATION,
    SINGULAR,
    SOLVABLE,
    TIE,
    TRIALS,
    UNLIMITED,
)
from derive.ir.passes import untold
from derive.ir.program import FindRoot, Status
from derive.ir.reason import Why
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import TIE_OF_LENGTHS, chooses_by_lengths
from derive.report.reasons import NO_MEANING, OTHER_TURN, reasons_of

name = "python"
PACKAGE = "softkin"
"""The package of the catalogue."""
_VERSION = "0.1.0"
"""The version of the package, and of each package that is made for a user's machines."""
_OF_THE_SEARCH = (
    *("AHEAD", "ASIDE", "BENT", "CELLS", "CLOSING", "FINEST", "FLAT", "GAP", "NARROW", "NEAR_ZERO"),
    *("NEXT", "RESERVE", "RIM", "SEAM", "SHIFTS", "TOUCHED", "TURNED", "VANISHING"),
)

_FIXED = (
    "LICENSE",
    "pyproject.toml",
    "softkin/_array.py",
    "softkin/_array_coupled.py",
    "softkin/_array_mounted.py",
    "softkin/_array_programs/__init__.py",
    "softkin/_array_rotation.py",
    "softkin/_batch.py",
    "softkin/_cells.py",
    "softkin/_columns.py",
    "softkin/_configuration.py",
    "softkin/_core.py",
    "softkin/_coupled.py",
    "softkin/_differential.py",
    "softkin/_ends.py",
    "softkin/_frame.py",
    "softkin/_input.py",
    "softkin/_limits.py",
    "softkin/_mounted.py",
    "softkin/_names.py",
    "softkin/_nearest.py",
    "softkin/_nearest_batch.py",
    "softkin/_offset.py",
    "softkin/_orientation.py",
    "softkin/_path.py",
    "softkin/_radians.py",
    "softkin/_radians_array.py",
    "softkin/_rotation.py",
    "softkin/_root.py",
    "softkin/_roots.py",
    "softkin/_scalar.py",
    "softkin/_search.py",
    "softkin/_slerp.py",
    "softkin/_solutions.py",
    "softkin/_start.py",
    "softkin/_table.py",
    "softkin/_tools.py",
    "softkin/_twist.py",
    "softkin/_types.py",
    "softkin/_unrolled/__init__.py",
    "softkin/_value.py",
    "softkin/_vectors.py",
    "softkin/_velocities.py",
    "softkin/py.typed",
)
"""The files that do not depend on the mechanisms."""
_INDEXED = ("README.md", "softkin/__init__.py")
"""The files that list the mechanisms."""
_EXPORTS = (
    "Axis", "Configuration", "ConfigurationByte", "Coupled", "Diagnosis", "Frame", "FrameLike", "KinematicsError",
    "Mechanism", "Mounted", "OrientationImage", "Parameter", "Rotation", "Singularity", "Solution", "Status",
    "__version__", "catalogue", "orthonormalize",
)  # fmt: skip
_MADE = ("Axis", "ConfigurationByte", "Diagnosis", "Parameter", "Status")
"""The types of which a module creates values; it names all other types in annotations alone."""
_TEXT = 110
"""The most columns of a line of a docstring."""
_CHUNK = 8192
"""The rows of a batch that are computed together: an array then has 64 KiB."""
_MEANINGS = {
    Status.OK: "no error",
    Status.NOT_INITIALIZED: "a parameter is not allowed",
    Status.BAD_INPUT: "numbers must be finite and at most 1e9 in size, and a rotation must be one",
    Status.UNREACHABLE: "out of reach or beyond a limit",
    Status.IMPOSSIBLE: "the mechanism cannot be assembled there, or a joint is undetermined",
    Status.INVALID_COUPLING: "this pair of position and orientation kinematics is impossible",
}


def part(kinematics: Kinematics) -> Part:
    """The files of one mechanism, and its entries in the lists."""
    found = {"index": _index(kinematics), "files": _mechanism(_templates(), kinematics)}
    return {**found, "notes": list(inputs(kinematics).notes)}


def files(parts: Sequence[Part]) -> dict[str, str]:
    """All files of the package: path → text."""
    return formatted(texts(parts, PACKAGE))


def texts(parts: Sequence[Part], package: str) -> dict[str, str]:
    """The same before it is laid out, for a package of any name; modules import each other from `softkin`."""
    templates = _templates()
    index = [part["index"] for part in parts]
    index.sort(key=lambda entry: entry["module"])
    exports = _sorted({*_EXPORTS, *(entry["class_name"] for entry in index)})
    known = {"package": package, "index": index, "exports": exports}
    files = {path: templates.get_template(f"{path}.j2").render(known) for path in (*_FIXED, *_INDEXED)}
    for part in parts:
        files |= part["files"]
    return files


@cache
def _templates() -> Environment:
    templates = environment(name)
    templates.filters |= {"paragraph": _paragraph, "literal": entries.literal}
    templates.globals |= {
        "generated": GENERATED,
        "statuses": [{"name": s.name, "softmotion": s.value, "meaning": _MEANINGS[s]} for s in Status],
        "version": _VERSION,
        "chunk": _CHUNK,
        "values_of_a_search": OF_A_SEARCH,
        "edge": literal(float(EDGE)),
        "held": literal(float(HELD)),
        "free_angle": literal(float(FREE_ANGLE)),
        "largest": literal(float(LARGEST)),
        "least": literal(float(LEAST)),
        "rotation": rotation_functions(),
        "largest_error": literal(float(ROTATION)),
        "search_constants": {name: _literal((vars(cells) | vars(roots))[name]) for name in _OF_THE_SEARCH},
        "exact": literal(float(EXACT_ROTATION)),
        "one_turn": literal(int(ONE_TURN)),
        "geared_turn": literal(float(GEARED_TURN)),
        "pivot": literal(float(PIVOT)),
        "singular": literal(float(SINGULAR)),
        "cells": _after_docstring(Path(cells.__file__).read_text()),
        "roots": _after_docstring(Path(roots.__file__).read_text()),
        "trials": TRIALS,
        "finished": FINISHED,
        "solvable": literal(float(SOLVABLE)),
        "tie": literal(float(TIE)),
        "no_meaning": NO_MEANING,
        "below": entries.literal(Why.BELOW.value),
        "above": entries.literal(Why.ABOVE.value),
        "other_turn": entries.literal(OTHER_TURN),
        "kinds_of_parameters": {role.value: entries.usual(role) for role in Role},
        "limit": literal(float(LIMIT)),
        "unlimited": literal(float(UNLIMITED)),
    }
    return templates


def _literal(value: float | tuple[float, ...]) -> str:
    """The literal of a constant of the search."""
    return f"({', '.join(map(literal, value))})" if isinstance(value, tuple) else literal(value)


def _after_docstring(source: str) -> str:
    """The text of a module of the compiler without docstring and first import, as a part of the package."""
    text = source.split("from __future__ import annotations", 1)[1].strip()
    return text.replace("from derive.ir.cells", "from softkin._cells").replace("import TypeVar", "import Any, TypeVar")


def _index(kin: Kinematics) -> dict[str, Any]:
    mechanism = kin.mechanism
    return {
        "name": mechanism.name,
        "class_name": entries.class_name(mechanism.name, mechanism.class_name),
        "module": entries.module_name(mechanism.name),
        "summary": mechanism.summary,
        "example": entries.example(kin),
    }


def _mechanism(templates: Environment, kin: Kinematics) -> dict[str, str]:
    """The class of a mechanism, and its programs on arrays."""
    names = _index(kin)
    programs = (*shared(kin), *forwards(kin), branch(kin), limits(kin), *differential(kin))
    arrays = [_untold(m) for m in (*programs, *projection(kin), *end_point_shift(kin))]
    lean = unrolled(kin) if is_unrolled(kin) else None
    contexts = {
        "": ("mechanism.py.j2", _class_context(kin, arrays, lean)),
        "_array_programs/": ("arrays.py.j2", _array_context(kin, arrays)),
        "_unrolled/": ("unrolled.py.j2", {"unrolled": lean}),
    }
    return {
        f"softkin/{folder}{names['module']}.py": templates.get_template(template).render(names | context)
        for folder, (template, context) in contexts.items()
        if lean or folder != "_unrolled/"
    }


def _class_context(kin: Kinematics, arrays: Sequence[Method], lean: Unrolled | None) -> dict[str, Any]:
    """What the text of the class reads; `lean` are the branches in a straight line, where it has them."""
    scalar = methods(kin)
    reasons = explained(reasons_of(kin))
    bodies = [scalar_body(m, reasons) if m.is_explained else scalar_body(_untold(m)) for m in scalar]
    trusted = trusted_branch(kin) if is_trusted(kin) else None
    setup_lines = setup.setup_body(kin, _constants_read(kin, (*scalar, *arrays), lean or trusted))
    types = _types(kin, scalar)
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
        "lean": lean,
        "trusted": trusted,
        "slots": ("_all_trusted", "_constants", "_finish", "_one_trusted") if lean else ("_constants",),
        "of_configuration": [
            *(["Criterion"] if chooses_by_lengths(kin.mechanism) else []),
            *(["period"] if entries.turn_sizes(kin) else []),
        ],
        "chooses_by_lengths": chooses_by_lengths(kin.mechanism),
        "has_folds": has_folds(kin),
        "margins": tuple(m.name for m in kin.margins),
        "every_root": _every_root(scalar),
        "methods": [
            {"head": _head(m, "_"), "summary": m.summary, "body": b} for m, b in zip(scalar, bodies, strict=True)
        ],
        **_called(kin, bodies, (*setup_lines, *(trusted.body if trusted else ()))),
    }


def _called(kin: Kinematics, bodies: Sequence[Sequence[str]], further: Sequence[str]) -> dict[str, Any]:
    """The functions of the package that the class calls, in its methods and in further lines."""
    lines = [line for body in bodies for line in body]
    return {
        "primitives": primitives_in((*lines, *further)),
        "of_limits": [n for n in ("beyond", "beyond_turn", "turn_inside") if any(f"{n}(" in line for line in lines)],
        "searches": any(map(has_search, kin.shared)),
    }


def _array_context(kin: Kinematics, arrays: Sequence[Method]) -> dict[str, Any]:
    """What the text of the programs on arrays reads."""
    array_programs = _array_programs(kin)
    texts = [(_array_head(m), array_body(m)) for m in arrays]
    lines = [line for head, body in texts for line in (head, *body)]
    return {
        "array_programs": array_programs,
        "imports": _sorted({array_programs} | named_in(lines, CALLED)),
        "types": _sorted(named_in(lines, TYPES)),
        "values": values_of_a_row(kin),
        "methods": [
            {"head": head, "summary": m.summary, "body": body} for m, (head, body) in zip(arrays, texts, strict=True)
        ],
        "searches": any(map(has_search, kin.shared)),
    }


def _constants_read(kin: Kinematics, programs: Iterable[Method], lean: Unrolled | Function | None) -> set[str]:
    """The constants that a program or the text around the programs reads."""
    found = {name for method in programs for name in constants_of(method)} | set(lean.constants if lean else ())
    found |= {TIE_OF_LENGTHS.name} if chooses_by_lengths(kin.mechanism) else set()
    search = kin.mechanism.search
    return found | ({"searched"} if search is not None and search.where is not None else set())


def _every_root(found: Sequence[Method]) -> list[str]:
    """The body of the method that finds all roots of a search; empty for a mechanism without a search."""
    for method in (m for m in found if has_search(m.program)):
        (search,) = method.program.body
        assert isinstance(search, FindRoot)
        return [*unpacked(method), *every_root(search, ScalarPrinter())]
    return []


def _array_programs(kin: Kinematics) -> str:
    """The base class of the programs on arrays, by the calls that the mechanism offers."""
    if kin.mechanism.is_orientation:
        return "OrientationPrograms"
    return "Programs" if kin.forward_from is None else "StartedPrograms"


def _bases(kin: Kinematics) -> dict[str, str]:
    """The modules and names of the base classes: they hold the calls that only some mechanisms offer."""
    found = {"_offset": "OffsetKinematics"} if kin.offset_branch is not None else {}
    found |= {"_orientation": "OrientationKinematics"} if kin.mechanism.is_orientation else {}
    found |= {"_search": "SearchedInverse"} if kin.mechanism.search is not None else {}
    found |= {"_start": "IterativeForward"} if kin.forward_from is not None else {}
    found |= {"_twist": "TwistChoice"} if kin.chooses_twist else {}
    return found or {"_core": "Mechanism"}


def _types(kin: Kinematics, used: Sequence[Method]) -> list[str]:
    kinds = {m.kind for m in used if m.kind} | {a.kind for m in used for a in m.arguments}
    lean = {"PlainFrame", "Reals", "Rotation", "Signs", "Vector"} if can_be_unrolled(kin) else set()
    lean |= {"ConfigurationByte"} if kin.configuration_size else set()
    lean |= {"Configuration"} if entries.turn_sizes(kin) else set()
    lean |= {"Axis"} if kin.mechanism.joints else set()
    return _sorted(kinds - {"Pose", "Image", "TotalImage"} | {"Diagnosis", "Parameter", "Reals", "Status"} | lean)


def _untold(method: Method) -> Method:
    """The method in the form that refuses with a status alone, without a reason."""
    return replace(method, program=untold(method.program))


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


def _sorted(found: set[str]) -> list[str]:
    """The names in alphabetical order: constants, then classes, then functions."""
    return sorted(found, key=lambda n: (not n.isupper(), n[0].islower(), n))


def _paragraph(text: str, indent: int = 0) -> str:
    """A text broken into the lines of a docstring, each with an indent."""
    space = " " * indent
    return "\n".join(wrap(text, _TEXT, initial_indent=space, subsequent_indent=space))
