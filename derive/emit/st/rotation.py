"""The repair of the commanded rotation in Structured Text: the body of the function that all blocks call, and the texts
of its reasons."""

from __future__ import annotations

from dataclasses import dataclass, replace

import sympy as sp

from derive.emit.st.contract import Contract, Signature
from derive.emit.st.expression import StructuredText, literal
from derive.emit.st.layout import wrapped
from derive.emit.st.program import Printed, printed
from derive.emit.st.refusal import MISSING, REASON, Explained, Refusal
from derive.equations.rotation_repair import rotation_program, surely_exact
from derive.equations.windows import limits_of_axis
from derive.ir.constants import GEARED_TURN, LARGEST
from derive.ir.passes import normalise, with_inputs
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import ROTATION_ENTRIES
from derive.kinematics.flange_rotation import projection_about_z
from derive.report.reasons import reasons_of_rotation, rotation_texts

_FUNCTION, _REPAIR = "Softkin_MakeRotation", "Softkin_RepairRotation"
_ARRAY = "aElements"


@dataclass(frozen=True)
class RotationFunction:
    """The values that the templates read."""

    name: str
    checked: Printed
    """The test that all elements are numbers."""
    is_exact: tuple[str, ...]
    """The lines of the condition under which nothing has to be repaired."""
    repair: str
    """The name of the function that repairs."""
    program: Printed
    reasons: tuple[str, ...]
    """The reasons; the number of a reason is its position, counted from 1."""


def rotation_function(contract: Contract) -> RotationFunction:
    """The function in Structured Text."""
    errors, error = contract.spelling["errors"], contract.spelling["types"]["error"]
    texts = rotation_texts()
    given = {r.name: f"{_ARRAY}[{r.name[1]}, {r.name[2]}]" for r in ROTATION_ENTRIES}
    whole, taken = rotation_program(), (_FUNCTION, _REPAIR, _ARRAY, REASON, MISSING)
    count = next(place for place, statement in enumerate(whole.body) if isinstance(statement, Let))
    checks = with_inputs(replace(whole, body=whole.body[:count], outputs=()))
    rest = with_inputs(replace(whole, body=whole.body[count:]))
    printer = StructuredText(given)
    is_exact = wrapped(f"IF {' AND '.join(f'({printer.print(c)})' for c in surely_exact())} THEN")

    def body(name: str, part: Program) -> Printed:
        refusal = Explained(Signature(name, "BOOL", ()), errors, error, reasons_of_rotation(), texts)
        return printed(part, given, {}, taken, refusal)

    first, program = body(_FUNCTION, checks), body(_REPAIR, rest)
    return RotationFunction(_FUNCTION, first, tuple(is_exact), _REPAIR, program, texts)


_ENTRIES = {r.name: f"rot[{r.name[1]}, {r.name[2]}]" for r in ROTATION_ENTRIES}


def followed(signature: Signature, contract: Contract) -> Printed:
    """The projection of a flange that follows the whole rotation."""
    return _printed(normalise("projection", (), [Output(r.name, r) for r in ROTATION_ENTRIES]), signature, contract)


def about_z(signature: Signature, contract: Contract) -> Printed:
    """The projection to the nearest turn about z."""
    return _printed(projection_about_z(sp.eye(3)), signature, contract)


def _printed(program: Program, signature: Signature, contract: Contract) -> Printed:
    refusal = Refusal(signature, contract.spelling["errors"], contract.spelling["types"]["error"])
    return printed(program, _ENTRIES, {}, [p.name for p in signature.parameters], refusal)


_RANGE = "Softkin_SetAxis"
_OF_RANGE = {
    "own_unlimited": "ownUnlimited",
    "own_lower": "ownLower",
    "own_upper": "ownUpper",
    "drive_limited": "xLimited",
    "drive_lower": "dLower",
    "drive_upper": "dUpper",
}


@dataclass(frozen=True)
class LimitsFunction:
    """The values that the template reads."""

    program: Printed
    variables: tuple[tuple[str, str], ...]
    """The variables of the function, with their types."""
    one_turn: str = literal(float(GEARED_TURN))
    """The widest range, in degrees of the joint, that holds one value for every direction."""
    unlimited: str = literal(float(LARGEST))
    """Where the range of an axis without limits ends."""


def limits_function(contract: Contract) -> LimitsFunction:
    """The function in Structured Text."""
    errors, error = contract.spelling["errors"], contract.spelling["types"]["error"]
    program = limits_of_axis()
    results = {o.name: {"single": "isSingle"}.get(o.name, o.name) for o in program.outputs}
    refusal = Refusal(Signature(_RANGE, error, ()), errors, error)
    text = printed(program, _OF_RANGE, results, (_RANGE, *_OF_RANGE.values()), refusal)
    given = (("ownUnlimited", "BOOL"), ("ownLower", "LREAL"), ("ownUpper", "LREAL"))
    found = (("lowest", "LREAL"), ("highest", "LREAL"), ("isSingle", "BOOL"), ("middle", "LREAL"))
    return LimitsFunction(text, (*given, *found, *text.variables))
