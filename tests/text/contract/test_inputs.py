"""Every input of a block tells what it is, its unit and its range."""

import re

import pytest

from tests.text.contract.blocks import UNITS, blocks

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("file", UNITS)
def test_inputs_are_documented(file: str) -> None:
    """Every block and every input has the attributes that the configurator shows."""
    block = blocks()[file]
    assert any("'sm_kin_libdoc'" in p for p in block.pragmas)
    axes = [p for p in block.pragmas if "'sm_kin_axes'" in p]
    assert len(axes) == (file != "orientation/Softkin_Tool.st")
    assert all(re.fullmatch(r"\{attribute 'sm_kin_axes' := '\w+(, \w+)*'\}", a) for a in axes)
    for title in (
        "**Axes**",
        "**Parameters**",
        "**Configuration**",
        "**Singularities**",
        "**Workspace**",
        "**Verification**",
    ):
        assert title in block.comment
    for given in (v for s in block.sections if s.scope == "VAR_INPUT" for v in s.variables):
        assert given.comment and given.initial is not None
        kind, prefix = given.type.text, given.name[0]
        assert {"LREAL": "d", "BOOL": "x", "INT": "i"}[kind] == prefix
        interval = [p for p in given.pragmas if "'sm_kin_param_range'" in p]
        assert len(interval) == (kind != "BOOL")
        for pragma in interval:
            assert re.search(r":= '[\[\]](-inf|-?\d+) \.\. (\+inf|-?\d+)[\[\]]'\}", pragma)
            assert "-inf" not in pragma or "']-inf" in pragma
            assert "+inf" not in pragma or "+inf['" in pragma
        unit = [p.split("'")[3] for p in given.pragmas if "'sm_kin_param_unit'" in p]
        assert (
            unit
            or kind != "LREAL"
            or given.name in ("dMinType2Margin", "dWarningDistance")
            or given.name.startswith("dCoupling")
        ), "a number"
        if given.name.startswith(("dLinkLength", "dArmLength")):
            assert unit == ["u"]


def test_vendor_ranges_are_half_open() -> None:
    """The ranges of inputs are written as half-open intervals."""
    block = blocks()["scara/Kin_Scara4_ZCcoupled_Type1.st"]
    inputs = {v.name: v for s in block.sections if s.scope == "VAR_INPUT" for v in s.variables}
    assert "{attribute 'sm_kin_param_range' := ']0 .. 800]'}" in inputs["dLinkLength1"].pragmas
    assert "{attribute 'sm_kin_param_range' := '[-200 .. 200]'}" in inputs["dPitchZC"].pragmas
    assert {"xCheckLimits", "dOffsetA1", "dLowerA4", "dUpperA4"} <= inputs.keys()
