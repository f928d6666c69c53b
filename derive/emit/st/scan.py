"""The root scan in Structured Text: a private method that calls two programs.

`FindRoot` has the same text for every mechanism, except for the arguments that it passes on. `TryAt` evaluates the
trial at a point of a cell.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from derive.emit.st.contract import Parameter, Signature
from derive.emit.st.expression import literal
from derive.emit.st.layout import packed
from derive.emit.st.names import parameter_name
from derive.emit.st.shared import method_name
from derive.ir import cells, roots
from derive.ir.constants import FINISHED, TRIALS
from derive.ir.program import FindRoot, Program
from derive.ir.symbols import PLACE, is_count

TRY_AT = "TryAt"
_STACKED, _PLACES = 60, 48
SEARCH = {
    "cells": roots.CELLS,
    "closing": roots.CLOSING,
    "shifts": roots.SHIFTS,
    "trials": TRIALS - roots.RESERVE,
    "finished": FINISHED,
    "stacked": _STACKED,
    "places": _PLACES,
    "aside": literal(cells.ASIDE),
    "bent": literal(cells.BENT),
    "near_zero": literal(cells.NEAR_ZERO),
    "ahead": literal(roots.AHEAD),
    "vanishing": literal(roots.VANISHING),
    "next": literal(roots.NEXT),
    "touched": literal(cells.TOUCHED),
    "finest": literal(cells.FINEST),
    "seam": literal(cells.SEAM),
    "turned": literal(cells.TURNED),
    "narrow": literal(cells.NARROW),
    "rim": literal(roots.RIM),
    "gap": literal(cells.GAP),
}
"""The constants of a root scan, by the names in the text."""


@dataclass(frozen=True)
class SearchText:
    """The parts of which the templates make the two methods."""

    given: tuple[str, ...]
    """The real arguments of a trial, as the scan names them."""
    chosen: tuple[str, ...]
    """The signs among the arguments of a trial, as the scan names them."""
    columns: int
    """The number of results of a trial."""
    directions: int
    tried_outputs: tuple[str, ...]
    try_call: str
    finish_call: str
    success: str
    nothing: str
    may_be_left_out: bool
    """Whether some machines need no scan."""
    sides: tuple[int, ...]
    """Where candidates are listed: the side of each."""


def search_in(program: Program) -> FindRoot | None:
    """The root scan, if a program consists of one; else None."""
    return next((s for s in program.body if isinstance(s, FindRoot)), None)


def try_at_signature(search: FindRoot) -> Signature:
    """The signature of the method that evaluates the trial at a point of a cell."""
    inputs = {"dBase": "LREAL", "dScale": "LREAL", "xCurved": "BOOL", "dS": "LREAL", "iFreed": "INT", "dAngle": "LREAL"}
    numbers, signs = _given(search)
    arrays = {"aGiven": (numbers, "LREAL"), "aSigns": (signs, "INT"), "aResults": (search.trial.outputs, "LREAL")}
    parameters = [Parameter("VAR_INPUT", name, kind) for name, kind in inputs.items()]
    sized = {name: f"ARRAY[1..{len(own)}] OF {kind}" for name, (own, kind) in arrays.items() if own}
    parameters += [Parameter("VAR_IN_OUT", name, kind) for name, kind in sized.items()]
    return Signature(TRY_AT, "", tuple(parameters), "PRIVATE")


def search_text(search: FindRoot) -> SearchText:
    """The parts of both methods."""
    given, chosen = _given(search)
    numbers = {name: f"aGiven[{k}]" for k, name in enumerate(given, 1)}
    numbers |= {name: f"aSigns[{k}]" for k, name in enumerate(chosen, 1)}
    cell = {"tried": "place", "side": "SEL(xCurved AND (dS < 0.0), 1, -1)", "freed": "iFreed", "freed_angle": "dAngle"}
    root = {
        "tried": "joints[nearest]",
        "side": "sides[nearest]",
        "freed": "-1" if search.is_listed else "freedAt[nearest]",
        "freed_angle": "0.0" if search.is_listed else "angles[nearest]",
    }
    outputs = [parameter_name(o.name) for o in search.trial.outputs]
    found = [parameter_name(o.name) for o in search.finish.outputs]
    targets = [parameter_name(n.name) for n in search.names]
    return SearchText(
        given=tuple(given),
        chosen=tuple(chosen),
        columns=len(outputs),
        directions=(len(outputs) - 4) // 2,
        tried_outputs=tuple(outputs),
        try_call=_call(
            search.trial, _arguments(search, search.trial, {} if search.is_listed else cell | numbers), outputs
        ),
        finish_call=_call(search.finish, _arguments(search, search.finish, root), found),
        success=f"{targets[0]} := TRUE;",
        nothing="\n".join([f"{targets[0]} := FALSE;", *(f"{t} := 0.0;" for t in targets[1:])]),
        may_be_left_out=search.wanted != sp.true,
        sides=search.sides,
    )


def _given(search: FindRoot) -> tuple[list[str], list[str]]:
    """The real arguments and the signs of a trial."""
    given = [s for s in search.given(search.trial) if s not in PLACE]
    return [parameter_name(s.name) for s in given if not is_count(s)], [
        parameter_name(s.name) for s in given if is_count(s)
    ]


def _arguments(search: FindRoot, program: Program, places: Mapping[str, str]) -> list[str]:
    """The arguments of a program: a coordinate of the trial, or an argument of the scan by its name."""
    found = []
    for s in search.given(program):
        name = parameter_name(s.name)
        found.append(f"{name} := {places.get(s.name, places.get(name, name))}")
    return found


def _call(program: Program, arguments: Sequence[str], outputs: Sequence[str]) -> str:
    lines = [*packed([f"{a}," for a in arguments]), *packed([f"{o} => {o}," for o in outputs])]
    lines[-1] = lines[-1].removesuffix(",") + ");"
    return "\n".join([f"{method_name(program)}(", *(f"  {line}" for line in lines)])
