"""The interface `ISoftkin` has our own methods, and no block has another header for one."""

from __future__ import annotations

import pytest

from tests.harness import ast
from tests.harness.contract import header
from tests.harness.faults import StError
from tests.harness.library import compile_st
from tests.text.contract.blocks import CONTRACT, FILES, library

pytestmark = pytest.mark.slow


def test_the_interface_has_our_own_methods() -> None:
    """Methods alone, those of the contract, with the headers that every block has: the check of types compares them."""
    interface = library().objects["ISoftkin"]
    assert isinstance(interface, ast.Interface) and interface.extends == ("__SYSTEM.IQueryInterface",)
    assert {m.name: header(m) for m in interface.methods} == {
        name: (name, s.returns, *((p.scope, p.name, p.type) for p in s.parameters)) for name, s in CONTRACT.own.items()
    }
    of_axes = {"Jacobian", "AxisVelocities", "AxisAccelerations", "Margins"}
    assert set(CONTRACT.own) == {"Diagnose", "InitializeReason", *of_axes, *(f"{name}From" for name in of_axes)}


SCARA = "scara/Softkin_Scara2_Z.st"
INTERFACE, BASE = "softkin/ISoftkin.st", "softkin/Softkin_Kinematics.st"
WRONG_HEADERS = {
    "a method more": (
        INTERFACE, "METHOD InitializeReason", "METHOD Explain : BOOL\nEND_METHOD\n\nMETHOD InitializeReason",
        "Softkin_Scara2_Z lacks the method Explain of ISoftkin",
    ),
    "another access": (BASE, "METHOD PUBLIC Margins", "METHOD PROTECTED Margins", "ISoftkin.Margins must be public"),
    "another name": (INTERFACE, "  iTurn : INT;", "  iPeriod : INT;", "the header of Diagnose is not that of ISoftkin"),
    "another type": (INTERFACE, "aMargins : ARRAY[0..7]", "aMargins : ARRAY[0..8]", "the header of Margins"),
    "another result": (INTERFACE, "InitializeReason : STRING(255)", "InitializeReason : STRING(80)", "the header of"),
    "another order": (
        INTERFACE, "  aTwist : ARRAY[0..5] OF LREAL;\n  a : TRAFO.AXISPOS_REF;",
        "  a : TRAFO.AXISPOS_REF;\n  aTwist : ARRAY[0..5] OF LREAL;", "the header of AxisVelocities",
    ),
    "another base": (INTERFACE, " EXTENDS __SYSTEM.IQueryInterface", "", "extends nothing that a query finds"),
    "a base that is not there": (INTERFACE, "__SYSTEM.IQueryInterface", "__SYSTEM.IQuery", "unknown interface"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG_HEADERS)
def test_another_header_is_refused(case: str) -> None:
    """A block whose method is not that of the interface does not compile."""
    file, old, new, message = WRONG_HEADERS[case]
    texts = {name: text for name, text in FILES.items() if name.startswith("softkin/") or name == SCARA}
    assert old in texts[file]
    with pytest.raises(StError, match=message):
        compile_st({**texts, file: texts[file].replace(old, new)})
