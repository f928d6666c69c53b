"""A program as statements of Structured Text: assignments, early returns, and the text of its outputs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import sympy as sp

from derive.emit.st.expression import StructuredText, is_size_test
from derive.emit.st.layout import commented, indented, wrapped
from derive.emit.st.loops import LOCALS, declarations, kept, loop_lines, solve_lines
from derive.emit.st.names import respelled, spellings, type_name
from derive.emit.st.refusal import Refusal
from derive.emit.st.shared import OUTCOME, call_lines
from derive.ir.constants import (
    DEGREE,
)
from derive.ir.primitives import (
    Select,
)
from derive.ir.program import (
    Call,
    FindRoot,
    Iterate,
    Let,
    Program,
    Require,
    Solve,
    Statement,
    Status,
)
from derive.ir.types import type_of
from derive.lowering.decided import decided

_SHORT = 72
"""A selection that fits in this many columns stays on one line."""


@dataclass(frozen=True)
class Printed:
    """A program in Structured Text."""

    variables: tuple[tuple[str, str], ...]
    """Its temporaries, with their types."""
    declarations: tuple[str, ...]
    """Further variables, with their types."""
    body: str
    outputs: Mapping[str, str]
    """The expression of every output, by its neutral name."""


def printed(
    program: Program, given: Mapping[str, str], stored: Mapping[str, str], taken: Iterable[str], refusal: Refusal
) -> Printed:
    """Spell a program.

    `given` spells what it reads, `stored` those of its bindings that are instance variables; the others are
    temporaries, and have none of the names in `taken`.
    """
    program = decided(program)
    stored = {**stored, **kept(program.body)}
    own = {name.name: name for name in program.bound() if name.name not in stored}
    temporaries = spellings(own, (*taken, *LOCALS, OUTCOME))
    printer = StructuredText({**given, **stored, **temporaries, DEGREE.name: "DEGREE"})
    return Printed(
        variables=tuple((temporaries[name], type_name(type_of(symbol))) for name, symbol in own.items()),
        declarations=(*declarations(program.body), *_outcome(program, refusal)),
        body="\n".join(_body(program.body, printer, refusal)),
        outputs={o.name: printer.print(o.value) for o in program.outputs},
    )


def _outcome(program: Program, refusal: Refusal) -> Iterator[str]:
    if any(isinstance(s, Call) for s in program.body):
        yield f"{OUTCOME} : {refusal.type};"


def _body(body: Sequence[Statement], printer: StructuredText, refusal: Refusal) -> Iterator[str]:
    for kind, group in groupby(body, key=lambda s: _kind(s, printer)):
        statements = list(group)
        first = statements[0]
        if isinstance(first, Solve):
            yield from commented([*solve_lines(first, printer), ""], respelled(first.note, printer.names))
            continue
        if isinstance(first, Call):
            yield from commented([*call_lines(first, printer, refusal), ""], respelled(first.note, printer.names))
            continue
        if isinstance(first, Iterate):
            step = list(_body(first.step, printer, refusal))
            lines = list(loop_lines(first, step, printer, refusal.of_loop(first)))
            yield from ("", *commented(lines, respelled(first.note, printer.names)), "")
            continue
        lets = [s for s in statements if isinstance(s, Let)]
        if isinstance(first, Require):
            lines = refusal.lines([s for s in statements if isinstance(s, Require)], printer)
            yield from commented(lines, respelled(first.comment, printer.names))
        elif isinstance(kind[0], str):
            yield from commented(_choice(kind[0], lets, printer), _notes(lets, printer.names))
        else:
            yield from _assignments(lets, printer)


Kind = tuple[Status | str | None, object, bool]


def _kind(statement: Statement, printer: StructuredText) -> Kind:
    """What statements in a row have in common that are printed together.

    Conditions that refuse alike, about the same subject, are one condition. Those on the size of inputs stay apart: AND
    evaluates both sides, and what follows them is defined only where they hold. Selections by one condition are one IF.
    """
    if isinstance(statement, Solve | Iterate | Call | FindRoot):
        return None, statement, False
    if isinstance(statement, Require):
        subject = None if statement.reason is None else statement.reason.subject
        return statement.otherwise, subject, all(map(is_size_test, sp.And.make_args(statement.condition)))
    if isinstance(statement.value, Select):
        return printer.print(statement.value.args[0]), "", False
    return None, "", False


def _notes(lets: Sequence[Let], names: Mapping[str, str]) -> str:
    return "; ".join(dict.fromkeys(respelled(let.comment, names) for let in lets if let.comment))


def _assignments(lets: Sequence[Let], printer: StructuredText) -> Iterator[str]:
    comment = ""
    for let in lets:
        lines = wrapped(_assignment(let, let.value, printer))
        yield from commented(lines, "" if let.comment == comment else respelled(let.comment, printer.names))
        comment = let.comment


def _choice(condition: str, lets: Sequence[Let], printer: StructuredText) -> list[str]:
    """Selections by one condition: a single short one as SEL, others as IF."""
    whole = [_assignment(let, let.value, printer) for let in lets]
    if len(whole) == 1 and len(whole[0]) <= _SHORT:
        return whole
    return [
        *wrapped(f"IF {condition} THEN"),
        *indented([line for let in lets for line in wrapped(_assignment(let, let.value.args[1], printer))]),
        "ELSE",
        *indented([line for let in lets for line in wrapped(_assignment(let, let.value.args[2], printer))]),
        "END_IF",
    ]


def _assignment(let: Let, value: sp.Expr, printer: StructuredText) -> str:
    return f"{printer.name(let.name)} := {printer.value(let.name, value)};"
