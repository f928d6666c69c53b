"""The range of an axis in Structured Text: the body of the function that combines the limits of a block and a drive."""

from __future__ import annotations

from dataclasses import dataclass

from derive.emit.st.contract import Contract, Signature
from derive.emit.st.expression import literal
from derive.emit.st.program import Printed, printed
from derive.emit.st.refusal import Refusal
from derive.equations.windows import limits_of_axis
from derive.ir.constants import GEARED_TURN, UNLIMITED

_FUNCTION = "Softkin_SetAxis"
_GIVEN = {
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
    unlimited: str = literal(float(UNLIMITED / 2))
    """More than any limit."""


def limits_function(contract: Contract) -> LimitsFunction:
    """The function in Structured Text."""
    errors, error = contract.spelling["errors"], contract.spelling["types"]["error"]
    program = limits_of_axis()
    results = {o.name: {"single": "isSingle"}.get(o.name, o.name) for o in program.outputs}
    refusal = Refusal(Signature(_FUNCTION, error, ()), errors, error)
    text = printed(program, _GIVEN, results, (_FUNCTION, *_GIVEN.values()), refusal)
    given = (("ownUnlimited", "BOOL"), ("ownLower", "LREAL"), ("ownUpper", "LREAL"))
    found = (("lowest", "LREAL"), ("highest", "LREAL"), ("isSingle", "BOOL"), ("middle", "LREAL"))
    return LimitsFunction(text, (*given, *found, *text.variables))
