"""Stretches that branches share, in Structured Text: the next branch reads values that one branch has computed.

The values are in a structure of the caller, which is empty at the begin of every call. A stretch that refused for one
branch refuses for every other branch that shares it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import sympy as sp

from derive.emit.braced import indented
from derive.emit.st.expression import StructuredText
from derive.emit.st.layout import INSIDE, WIDTH
from derive.emit.st.refusal import Refusal
from derive.ir.program import Program, Require
from derive.ir.symbols import branch_with, is_condition
from derive.ir.tree import Item
from derive.report.branch_stretches import Stretch, stretches_of

KNOWN, KEPT, SIDE = "shared.known", "shared.kept", "side"
"""The values that a caller keeps for all branches, and a number that says which signs of a stretch are positive."""
IS_SHARED = "choice.isShared"
"""Whether the caller solves several branches: one alone keeps no values for others."""
SOLVED, REFUSED = 1, 2
"""The state of a stretch; 0 before it was computed."""
Body = Callable[[Sequence[Item], int], Iterator[str]]
"""Writes statements within a width."""


def has_sides(program: Program) -> bool:
    """Whether some branches share values that depend on a sign."""
    return any(s.is_shared and s.signs for s in stretches_of(program))


def stretch_lines(program: Program, printer: StructuredText, refusal: Refusal, body: Body) -> Iterator[str]:
    """The statements of a branch; each shared stretch stands between two tests of its state."""
    number = row = 1
    for stretch in stretches_of(program):
        if not stretch.is_shared:
            yield from body(stretch.items, WIDTH)
            continue
        yield from _shared(stretch, (number, row), printer, refusal, body)
        number += stretch.sides
        row += stretch.sides * len(stretch.kept)


def _shared(
    stretch: Stretch, place: tuple[int, int], printer: StructuredText, refusal: Refusal, body: Body
) -> Iterator[str]:
    number, first = place
    known = f"{KNOWN}[{number}{f' + {SIDE}' if stretch.signs else ''}]"
    times = f"{len(stretch.kept)}*" if len(stretch.kept) > 1 else ""
    further = f" + {times}{SIDE}" if stretch.signs else ""
    places = [(f"{KEPT}[{first + k}{further}]", name) for k, name in enumerate(stretch.kept)]
    words = " and ".join(branch_with(sign) for sign in stretch.signs)
    yield f"// Equal in all branches{f' with this {words}' if words else ''}, so computed once a call"
    if stretch.signs:
        sides = (f"SEL({printer.name(s)} > 0, {2**k}, 0)" for k, s in enumerate(stretch.signs))
        yield f"{SIDE} := {' + '.join(sides)};"
    requires = [item for item in stretch.items if isinstance(item, Require)]
    if requires:
        yield f"IF {known} = {REFUSED} THEN"
        yield from indented(refusal.answering(refusal.errors[requires[0].otherwise.name]))
        yield "END_IF"
    if places:
        yield f"IF {known} = {SOLVED} THEN"
        yield from indented([_taken(kept, name, printer) for kept, name in places])
        yield "ELSE"
    else:
        yield f"IF {known} <> {SOLVED} THEN"
    for line in body(stretch.items, WIDTH - INSIDE):
        if line.strip() == "RETURN;":
            indent = line[: -len("RETURN;")]
            yield from indented([f"{indent}{one}" for one in _if_shared([f"{known} := {REFUSED};"])])
        yield from indented([line])
    yield from indented(_if_shared([*(_stored(kept, name, printer) for kept, name in places), f"{known} := {SOLVED};"]))
    yield "END_IF"


def _if_shared(lines: Sequence[str]) -> list[str]:
    return [f"IF {IS_SHARED} THEN", *indented(lines), "END_IF"]


def _stored(place: str, name: sp.Symbol, printer: StructuredText) -> str:
    """The statement that keeps a value; a flag is kept as a number."""
    value = printer.name(name)
    return f"{place} := SEL({value}, 0.0, 1.0);" if is_condition(name) else f"{place} := {value};"


def _taken(place: str, name: sp.Symbol, printer: StructuredText) -> str:
    """The statement that takes a kept value back."""
    return f"{printer.name(name)} := {place}{' > 0.5' if is_condition(name) else ''};"
