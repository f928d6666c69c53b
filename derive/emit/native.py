"""The native core of the Python package: the C of its machines, and the extension that joins it with their classes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from hashlib import sha256
from typing import Any

import sympy as sp
from jinja2 import Environment

from derive.emit.c import lanes
from derive.emit.c import package as c
from derive.emit.c.printer import laid_out, number, page
from derive.emit.language import GENERATED, environment, runtime
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics

FOLDER = "native"
"""The folder beside the package whose files are compiled, and never imported."""
_DIGITS = 16
_COUNT = 11
_EXACT_DIGITS = 40
_TOP = (sp.sqrt(2) - 1) ** 2
"""The square of tan 22.5°."""


def key(kin: Kinematics) -> str:
    """The key that a class and its C have in common: the module with a digest of the C. Empty if there is no C."""
    found = c.part(kin)
    return "" if found is None else f"{found['index']['module']} {_digest(_sources(kin))}"


def in_lanes(kin: Kinematics) -> list[str]:
    """The functions that compute several poses at a time: of one branch, and of every branch; empty if none do."""
    found = c.part(kin)
    return [] if found is None else [f"{found['index']['module']}_{one.name}" for one in lanes.in_lanes(kin)]


def sources(kin: Kinematics) -> dict[str, str]:
    """Header and source of the machine, and that of several poses at a time: path → text."""
    return {f"{FOLDER}/{path}": text for path, text in _sources(kin).items()}


@kept_by_identity(10)
def _sources(kin: Kinematics) -> dict[str, str]:
    found = c.part(kin)
    if found is None:
        return {}
    module, programs = found["index"]["module"], lanes.in_lanes(kin)
    if not programs:
        return dict(found["files"])
    known = {"module": module, "functions": [laid_out(lanes.lanes_lines(kin, module, one)) for one in programs]}
    text = page(_templates().get_template("machine_lanes.c.j2").render(known))
    return {**found["files"], f"{module}-lanes.c": text}  # no module has a hyphen


def extension(package: str) -> str:
    """The name of the extension: it stands beside the package, so that it can be built anywhere."""
    return f"_{package}_native"


def shared(listed: Sequence[Mapping[str, Any]], package: str) -> dict[str, str]:
    """The files of the core that hold no machine. listed: the entry of each machine in the lists of the package."""
    known = {
        "extension": extension(package),
        "sources": digest_of_shared(),
        "machines": [
            {"key": entry["key"], "module": entry["key"].split()[0], "lanes": entry["lanes"]}
            for entry in listed
            if entry["key"]
        ],
    }
    listing = {
        path: page(_templates().get_template(f"{path}.j2").render(known)) for path in ("machines.c", "machines.h")
    }
    return {f"{FOLDER}/{path}": text for path, text in {**_runtime(), **listing}.items()}


def digest_of_shared() -> str:
    """The digest of the C that all machines share: structures, calls, and the Python object."""
    return _digest(_runtime())


def _runtime() -> dict[str, str]:
    """The files that all machines share, whatever the package."""
    programs = "lane_programs.h"
    return {**c.shared(), **runtime(FOLDER), programs: page(_templates().get_template(f"{programs}.j2").render())}


@cache
def _templates() -> Environment:
    found = environment(FOLDER)
    even, odd = horner("zz")
    found.globals |= {"generated": GENERATED, "even": even, "odd": odd, "rotation": laid_out(lanes.rotation_lines())}
    return found


def _digest(files: Mapping[str, str]) -> str:
    text = "\0".join(part for path in sorted(files) for part in (path, files[path]))
    return sha256(text.encode()).hexdigest()[:_DIGITS]


@cache
def coefficients() -> tuple[float, ...]:
    """The coefficients of p, from that of 1 on, in atan t = t + t z p(z) with z = t², for t from 0 to tan 22.5°: angles
    of all octants follow by symmetry. A compiler can vectorise it, unlike a call of the C library.

    p interpolates at Chebyshev's nodes: with eleven coefficients its error is below rounding.
    """
    angles = ((2 * k + 1) * sp.pi / (2 * _COUNT) for k in range(_COUNT))
    nodes = [sp.N((1 + sp.cos(angle)) * _TOP / 2, _EXACT_DIGITS) for angle in angles]
    powers = sp.Matrix(_COUNT, _COUNT, lambda i, j: nodes[i] ** j)
    values = sp.Matrix([(sp.atan(sp.sqrt(z)) / sp.sqrt(z) - 1) / z for z in nodes])
    return tuple(float(c) for c in powers.LUsolve(values))


def horner(square: str) -> tuple[str, str]:
    """The terms of p with even and with odd powers, in C: two chains, which a processor computes side by side.

    square: the name of z².
    """
    even, odd = (_nested(coefficients()[start::2], square) for start in (0, 1))
    return even, odd


def _nested(numbers: tuple[float, ...], square: str) -> str:
    first, *others = (number(value) for value in numbers)
    if len(others) < 2:
        return " + ".join([first, *(f"{square}*{other}" for other in others)])
    return f"{first} + {square}*({_nested(numbers[1:], square)})"
