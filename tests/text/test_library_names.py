"""The list of names: the blocks use its constants alone, so a line that is changed in it changes every block."""

import re
from functools import cache
from typing import Any

import pytest

from derive.emit.st.contract import load
from derive.ir.program import Status
from tests.harness import ast
from tests.harness.library import Library, compile_st
from tests.text import values
from tests.text.contract.blocks import FILES, UNITS

LIST = "softkin/Softkin_Names.st"
CONSTANTS = {one.name: one for group in load().names for one in group.constants}
SCARA, WRIST, TOOL = "scara/Softkin_Scara2_Z.st", "orientation/Softkin_Wrist3.st", "orientation/Softkin_Tool.st"
STRANGE = "SMC_MODULO_AXIS_PERIOD_NOT_360"
"""An error that no block returns."""


def changed(name: str, value: str) -> str:
    """The list in which one constant has another value of the same type."""
    one = CONSTANTS[name]
    line = f"  {name} : {one.type} := {one.value};"
    assert FILES[LIST].split("\n").count(line) == 1
    given = value if one.type == "BOOL" else f"{one.type}.{value}"
    return FILES[LIST].replace(line, f"  {name} : {one.type} := {given};")


@cache
def library(name: str, value: str, *units: str) -> Library:
    """Units and what they share, with one line of the list changed."""
    texts = {file: text for file, text in FILES.items() if file.startswith("softkin/") or file in units}
    return compile_st({**texts, LIST: changed(name, value)})


def test_the_list_is_the_contract() -> None:
    """The list declares every constant of the contract once; those that no document names say so."""
    (found,) = (d for d in compile_st({LIST: FILES[LIST]}).objects.values() if isinstance(d, ast.Globals))
    assert found.constant and found.pragmas == ("{attribute 'qualified_only'}",)
    assert [v.name for v in found.variables] == list(CONSTANTS)
    doubtful = {v.name for v in found.variables if "not documented" in v.comment}
    assert doubtful == {"NotInitialized", "BadInput", "LinearAxis", "ActiveWithoutTurn"}
    errors = {c.value.split(".")[-1] for c in load().names[0].constants}
    assert errors == {status.value for status in Status}


def test_every_constant_is_used() -> None:
    """No constant of the list is there for nothing."""
    text = "\n".join(text for file, text in FILES.items() if file != LIST)
    assert set(re.findall(r"Softkin_Names\.(\w+)", text)) == set(CONSTANTS)


@pytest.mark.slow
def test_every_block_follows_a_changed_line() -> None:
    """Before Initialize every block answers with the error that the changed line names."""
    found = library("NotInitialized", STRANGE, *UNITS)
    frame = values.meaningless(found, values.FRAME_TYPE)
    for unit in UNITS:
        block = found.new(unit.split("/")[1].removesuffix(".st"))
        data, axes = found.new(values.BYTES_TYPE), found.new(values.AXES_TYPE)
        assert block.call("AxesToCartesian", f=frame, cd=data, a=axes) == STRANGE
        assert block.call("CartesianToAxes", a=axes, f=frame, aRef=axes, cd=data) == STRANGE


def ready(name: str, value: str, unit: str, **inputs: float) -> tuple[Library, Any]:
    """A block that is initialised, with one line of the list changed."""
    found = library(name, value, unit)
    block = found.new(unit.split("/")[1].removesuffix(".st"))
    for key, given in inputs.items():
        setattr(block, key, given)
    assert block.call("Initialize") == "SMC_NO_ERROR"
    return found, block


def inverse(found: Library, block: Any, x: float, y: float = 0.0) -> str:
    """What CartesianToAxes answers for a frame at a place."""
    frame = values.frame(found, (x, y, 0.0), ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    axes, data = found.new(values.AXES_TYPE), values.configuration(found, (1,))
    answer: str = block.call("CartesianToAxes", a=axes, f=frame, aRef=found.new(values.AXES_TYPE), cd=data)
    return answer


ARMS = {"dArmLength1": 300.0, "dArmLength2": 250.0}


@pytest.mark.parametrize(("name", "x"), [("Unreachable", 1000.0), ("BadInput", float("nan"))])
def test_an_error_is_the_one_of_the_list(name: str, x: float) -> None:
    """Beyond its reach and for no number a block answers what the list names."""
    assert inverse(*ready(name, STRANGE, SCARA, **ARMS), x) == STRANGE


def test_success_is_the_one_of_the_list() -> None:
    """What functions of the libraries answer is compared with the list: where it names another success, Initialize
    refuses.
    """
    found = library("NoError", STRANGE, SCARA)
    block = found.new("Softkin_Scara2_Z")
    assert block.call("Initialize") == "SMC_TRAFO_NOT_INITIALIZED"


@pytest.mark.parametrize(("name", "axis"), [("RotaryAxis", 0), ("LinearAxis", 2)])
def test_a_type_of_axis_is_the_one_of_the_list(name: str, axis: int) -> None:
    """The type of an axis is what the list names."""
    other = {"RotaryAxis": "Linear", "LinearAxis": "Rotary"}[name]
    found, block = ready(name, other, SCARA, **ARMS)
    properties = found.new("TRAFO.Axis_Properties")
    block.call("GetAxisProperties", props=properties, udiAxis=axis)
    assert properties.eType == other


def test_a_freedom_is_the_one_of_the_list() -> None:
    """The freedom of a flange that turns is what the list names."""
    found, block = ready("TurningOrientation", "three", SCARA, **ARMS)
    image = found.new(values.IMAGE_TYPE)
    block.call("GetOrientationImage", oriInfo=image)
    assert image.dof == "three"


@pytest.mark.parametrize(
    ("name", "value", "unit", "wanted"),
    [
        ("MachineFrame", "Flange", WRIST, ("Flange", True)),
        ("FlangeFrame", "MCS", TOOL, ("MCS", False)),
        ("ActiveWithoutTurn", "TRUE", TOOL, ("Flange", True)),
    ],
)
def test_a_frame_is_the_one_of_the_list(name: str, value: str, unit: str, wanted: tuple[str, bool]) -> None:
    """The frame of an orientation image, and whether it is active, are what the list names."""
    found, block = ready(name, value, unit)
    identity = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    base = found.new(values.IMAGE_TYPE)
    found.set_rotation(base.mOriZero, identity)
    _, outputs = block.call_with_outputs(
        "GetOrientationImageWithOri",
        oriInfo=found.new(values.IMAGE_TYPE),
        csOriKin="MCS",
        bActive=False,
        mR_flange=values.matrix(found, identity),
        aRef=values.axes(found, ()),
        cd=values.configuration(found, ()),
        oriInfoBase=base,
    )
    assert (outputs["csOriKin"], outputs["bActive"]) == wanted
