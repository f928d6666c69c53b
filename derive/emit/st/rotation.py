"""The repair of the commanded rotation in Structured Text: the body of the function that all blocks call, and the texts
of its reasons."""

from __future__ import annotations

from dataclasses import dataclass

from derive.emit.st.contract import Contract, Signature
from derive.emit.st.program import Printed, printed
from derive.emit.st.refusal import MISSING, REASON, Explained
from derive.equations.rotation_repair import rotation_program
from derive.ir.symbols import (
    ROTATION_ENTRIES,
)
from derive.report.reasons import reasons_of_rotation, rotation_texts

_FUNCTION = "Softkin_MakeRotation"
_ARRAY = "aElements"


@dataclass(frozen=True)
class RotationFunction:
    """The values that the templates read."""

    name: str
    program: Printed
    reasons: tuple[str, ...]
    """The reasons; the number of a reason is its position, counted from 1."""


def rotation_function(contract: Contract) -> RotationFunction:
    """The function in Structured Text."""
    errors, error = contract.spelling["errors"], contract.spelling["types"]["error"]
    texts = rotation_texts()
    refusal = Explained(Signature(_FUNCTION, "BOOL", ()), errors, error, reasons_of_rotation(), texts)
    given = {r.name: f"{_ARRAY}[{r.name[1]}, {r.name[2]}]" for r in ROTATION_ENTRIES}
    program = printed(rotation_program(), given, {}, (_FUNCTION, _ARRAY, REASON, MISSING), refusal)
    return RotationFunction(_FUNCTION, program, texts)
