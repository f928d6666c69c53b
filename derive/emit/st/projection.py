"""The part of a commanded rotation that a flange follows, in Structured Text, as the base block has it."""

from __future__ import annotations

import sympy as sp

from derive.emit.st.contract import Contract, Signature
from derive.emit.st.program import Printed, printed
from derive.emit.st.refusal import Refusal
from derive.ir.passes import normalise
from derive.ir.program import Output, Program
from derive.ir.symbols import ROTATION_ENTRIES
from derive.kinematics.flange_rotation import projection_about_z

_GIVEN = {r.name: f"rot[{r.name[1]}, {r.name[2]}]" for r in ROTATION_ENTRIES}


def followed(signature: Signature, contract: Contract) -> Printed:
    """The projection of a flange that follows the whole rotation."""
    return _printed(normalise("projection", (), [Output(r.name, r) for r in ROTATION_ENTRIES]), signature, contract)


def about_z(signature: Signature, contract: Contract) -> Printed:
    """The projection to the nearest turn about z."""
    return _printed(projection_about_z(sp.eye(3)), signature, contract)


def _printed(program: Program, signature: Signature, contract: Contract) -> Printed:
    refusal = Refusal(signature, contract.spelling["errors"], contract.spelling["types"]["error"])
    return printed(program, _GIVEN, {}, [p.name for p in signature.parameters], refusal)
