"""The repair of the commanded rotation in Structured Text: the body of the function that all blocks call, and the texts
of its reasons."""

from __future__ import annotations

from dataclasses import dataclass, replace

from derive.emit.st.contract import Contract, Signature
from derive.emit.st.expression import StructuredText
from derive.emit.st.layout import wrapped
from derive.emit.st.program import Printed, printed
from derive.emit.st.refusal import MISSING, REASON, Explained
from derive.equations.rotation_repair import rotation_program, surely_exact
from derive.ir.passes import with_inputs
from derive.ir.program import Let
from derive.ir.symbols import ROTATION_ENTRIES
from derive.report.reasons import reasons_of_rotation, rotation_texts

_FUNCTION = "Softkin_MakeRotation"
_ARRAY = "aElements"


@dataclass(frozen=True)
class RotationFunction:
    """The values that the templates read."""

    name: str
    checked: Printed
    """The test that all elements are numbers."""
    is_exact: tuple[str, ...]
    """The lines of the condition under which nothing has to be repaired."""
    program: Printed
    reasons: tuple[str, ...]
    """The reasons; the number of a reason is its position, counted from 1."""


def rotation_function(contract: Contract) -> RotationFunction:
    """The function in Structured Text."""
    errors, error = contract.spelling["errors"], contract.spelling["types"]["error"]
    texts = rotation_texts()
    refusal = Explained(Signature(_FUNCTION, "BOOL", ()), errors, error, reasons_of_rotation(), texts)
    given = {r.name: f"{_ARRAY}[{r.name[1]}, {r.name[2]}]" for r in ROTATION_ENTRIES}
    whole, taken = rotation_program(), (_FUNCTION, _ARRAY, REASON, MISSING)
    count = next(place for place, statement in enumerate(whole.body) if isinstance(statement, Let))
    checks = with_inputs(replace(whole, body=whole.body[:count], outputs=()))
    rest = with_inputs(replace(whole, body=whole.body[count:]))
    printer = StructuredText(given)
    is_exact = wrapped(f"IF {' AND '.join(f'({printer.print(c)})' for c in surely_exact())} THEN")
    first, program = (printed(p, given, {}, taken, refusal) for p in (checks, rest))
    return RotationFunction(_FUNCTION, first, tuple(is_exact), program, texts)
