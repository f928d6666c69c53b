"""Stretches that branches share, in Structured Text: what one branch has computed the next one reads.

The values are in two arrays of the caller, which begins every call with none. A stretch that refused for one branch
refuses for every other branch that shares it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from derive.emit.st.expression import StructuredText
from derive.emit.st.layout import INSIDE, WIDTH, indented
from derive.emit.st.refusal import Refusal
from derive.ir.program import Program, Require
from derive.ir.tree import Item
from derive.report.branch_stretches import Stretch, stretches_of

KNOWN, KEPT, SIDE = "known", "kept", "side"
"""The arrays of a caller, and the column of a stretch: which of its signs are positive."""
SOLVED, REFUSED = 1, 2
"""What is known of a stretch; 0 before it was computed."""
Body = Callable[[Sequence[Item], int], Iterator[str]]
"""Writes statements within a width."""


@dataclass(frozen=True)
class Shares:
    """The arrays through which branches share their stretches."""

    stretches: int
    values: int
    columns: int

    @property
    def parameters(self) -> tuple[tuple[str, str], ...]:
        """The arrays by name, with their types."""
        known = f"ARRAY[1..{self.stretches}, 1..{self.columns}] OF INT"
        return (KNOWN, known), (KEPT, f"ARRAY[1..{self.values}, 1..{self.columns}] OF LREAL")


def shares_of(program: Program) -> Shares | None:
    """The arrays of a branch; None where its branches share nothing."""
    found = [s for s in stretches_of(program) if s.is_shared]
    if not found:
        return None
    return Shares(len(found), max(sum(len(s.kept) for s in found), 1), max(s.sides for s in found))


def stretch_lines(program: Program, printer: StructuredText, refusal: Refusal, body: Body) -> Iterator[str]:
    """The statements of a branch, each stretch that is shared between two tests of what is known."""
    number, row = 0, 1
    for stretch in stretches_of(program):
        if not stretch.is_shared:
            yield from body(stretch.items, WIDTH)
            continue
        number += 1
        yield from _shared(stretch, (number, row), printer, refusal, body)
        row += len(stretch.kept)


def _shared(
    stretch: Stretch, place: tuple[int, int], printer: StructuredText, refusal: Refusal, body: Body
) -> Iterator[str]:
    number, first = place
    column = SIDE if stretch.signs else "1"
    known = f"{KNOWN}[{number}, {column}]"
    places = [(f"{KEPT}[{first + k}, {column}]", printer.name(name)) for k, name in enumerate(stretch.kept)]
    words = " and ".join(sign.name.removeprefix("sigma_") for sign in stretch.signs)
    yield f"// The same in all branches{f' with this {words}' if words else ''}: computed once a call"
    if stretch.signs:
        sides = (f"SEL({printer.name(s)} > 0, {2**k + (k == 0)}, {int(k == 0)})" for k, s in enumerate(stretch.signs))
        yield f"{SIDE} := {' + '.join(sides)};"
    requires = [item for item in stretch.items if isinstance(item, Require)]
    if requires:
        yield f"IF {known} = {REFUSED} THEN"
        yield from indented(refusal.answering(refusal.errors[requires[0].otherwise.name]))
        yield "END_IF"
    yield f"IF {known} = {SOLVED} THEN"
    yield from indented([f"{name} := {kept};" for kept, name in places])
    yield "ELSE"
    for line in body(stretch.items, WIDTH - INSIDE):
        if line.strip() == "RETURN;":
            yield from indented([line.replace("RETURN;", f"{known} := {REFUSED};")])
        yield from indented([line])
    yield from indented([f"{kept} := {name};" for kept, name in places])
    yield from indented([f"{known} := {SOLVED};"])
    yield "END_IF"
