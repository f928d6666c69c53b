"""A whole block in the emitted style: parsed by both grammars, checked, and run in both matrix orders."""

import math
import re
from pathlib import Path
from typing import Any

import pytest

from tests.harness.blark_grammar import parse_text_with_blark
from tests.harness.library import Library, StError, StFault, compile_st

FILE = Path(__file__).parent / "samples" / "Kin_Sample_Planar.st"
TEXT = FILE.read_text(encoding="utf-8")


def compiled(**options: Any) -> Library:
    return compile_st({FILE.name: TEXT}, **options)


def initialised(lib: Library) -> Any:
    kin = lib.new("Kin_Sample_Planar")
    assert kin.call("Initialize") == "SMC_NO_ERROR"
    return kin


@pytest.mark.slow
def test_blark_parses_every_piece() -> None:
    """The independent grammar reads every part of the sample."""
    trees = parse_text_with_blark(TEXT, FILE.name)
    assert len(trees) == 20
    assert "PROPERTY PUBLIC NumAxes : UDINT" in trees


@pytest.mark.slow
@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("IsInitialized := xInitialized;", "IsInitialized := xInitialized"),
        ("END_IF\nEND_METHOD", "END_METHOD"),
        ("NumAxes := 3;", "NumAxes = ;"),
    ],
)
def test_blark_refuses_broken_pieces(right: str, wrong: str) -> None:
    """The independent grammar and the harness both refuse text with a broken statement."""
    broken = TEXT.replace(right, wrong, 1)
    assert broken != TEXT
    with pytest.raises(StError, match="blark"):
        parse_text_with_blark(broken, FILE.name)
    with pytest.raises(StError):
        compile_st({FILE.name: broken})


def pose(lib: Library, kin: Any, a0: float, a1: float, a2: float) -> tuple[Any, Any]:
    a, f, cd = lib.new("TRAFO.AXISPOS_REF"), lib.new("SM3M.SMC_Frame"), lib.new("TRAFO.CONFIGDATA")
    a.a0, a.a1, a.a2 = a0, a1, a2
    assert kin.call("AxesToCartesian", f=f, cd=cd, a=a) == "SMC_NO_ERROR"
    return f, cd


@pytest.mark.parametrize("order", ["rows", "columns"])
@pytest.mark.parametrize(("a0", "a1"), [(10.0, 20.0), (-100.0, 130.0), (170.0, -45.0)])
def test_there_and_back_in_both_storage_orders(order: str, a0: float, a1: float) -> None:
    """Forward and inverse kinematics of the sample agree, whether matrices are stored by rows or by columns."""
    lib = compiled(order=order)
    kin = initialised(lib)
    f, cd = pose(lib, kin, a0, a1, 7.0)
    rotation = lib.get_rotation(f.mR)
    assert rotation[0][1] == pytest.approx(-math.sin(math.radians(a0 + a1)))
    assert rotation[1][0] == pytest.approx(math.sin(math.radians(a0 + a1)))
    back = lib.new("AXISPOS_REF")
    assert kin.call("CartesianToAxes", a=back, f=f, aRef=lib.new("AXISPOS_REF"), cd=cd) == "SMC_NO_ERROR"
    assert math.remainder(back.a0 - a0, 360.0) == pytest.approx(0.0, abs=1e-9)
    assert (back.a1, back.a2) == (pytest.approx(a1), 7.0)


def test_an_unreachable_point_is_an_error_and_no_fault() -> None:
    """A point out of reach is answered with an error code, and causes no run-time fault."""
    lib = compiled()
    kin = initialised(lib)
    f, cd = pose(lib, kin, 0.0, 30.0, 0.0)
    f.vT.dX = 1e6
    a = lib.new("AXISPOS_REF")
    result = kin.call("CartesianToAxes", a=a, f=f, aRef=a, cd=cd)
    assert result == "SMC_AXIS_INVERSE_TRAFO_EXCEEDING_POSLIMITS"


def test_garbage_faults_where_it_is_first_used() -> None:
    """A computation with NaN is a fault in the statement that uses it first."""
    lib = compiled()
    kin = initialised(lib)
    f, cd = pose(lib, kin, 0.0, 30.0, 0.0)
    f.vT.dX = math.nan
    line = 1 + TEXT[: TEXT.index("dCos := (f.vT.dX")].count("\n")
    with pytest.raises(StFault, match=f"^{re.escape(FILE.name)}:{line}: .*not finite"):
        kin.call("CartesianToAxes", a=lib.new("AXISPOS_REF"), f=f, aRef=lib.new("AXISPOS_REF"), cd=cd)


@pytest.mark.parametrize("size", [36, 80])
def test_a_matrix_of_another_size_stops_initialisation(size: int) -> None:
    """Initialize refuses to work with a library whose matrix has another size."""
    assert compiled(matrix_size=size).new("Kin_Sample_Planar").call("Initialize") == "SMC_TRAFO_NOT_INITIALIZED"


def test_the_configuration_block() -> None:
    """The configuration block of the sample writes the byte that belongs to each choice."""
    config = compiled().new("Kin_Sample_Planar_Config")
    for elbow, expected in (("Rightward", 1), ("Leftward", 2), ("Singular", 0)):
        config(eElbow=elbow)
        assert config.Config.abyData[0] == expected


def test_a_program_uses_instances() -> None:
    """A program can declare instances of function blocks and call their methods."""
    main = compiled().new("Sample_Main")
    main()
    assert (main.eError, main.cdActive.abyData[0], main.kin.xInitialized) == ("SMC_NO_ERROR", 2, True)


def test_pragmas_comments_and_initial_values_are_kept() -> None:
    """Pragmas, comments and initial values of a declaration can be read after compiling."""
    kin = compiled().objects["Kin_Sample_Planar"]
    assert kin.pragmas == ("{attribute 'sm_kin_libdoc'}", "{attribute 'sm_kin_axes' := 'A1, A2, Z'}")
    assert kin.comment.startswith("A planar arm")
    first = kin.sections[0].variables[0]
    assert first.pragmas[0] == "{attribute 'sm_kin_param_range' := ']0 .. +inf['}"
    assert (first.comment, first.initial.value, first.type.text) == ("length of the first link", 325.0, "LREAL")


def test_a_contract_can_be_kept_by_the_base() -> None:
    """A block satisfies an interface with methods that it inherits."""
    derived = (
        "FUNCTION_BLOCK Derived EXTENDS Kin_Sample_Planar IMPLEMENTS TRAFO.ISMKinematicWithInfo2\nEND_FUNCTION_BLOCK"
    )
    lib = compile_st({FILE.name: TEXT, "derived.st": derived})
    assert lib.new("Derived").call("GetKinematicsName") == "Planar sample"


CONTRACT = {
    "a method is missing": ("IsConfigSingular", "IsConfigOdd", "lacks the method IsConfigSingular"),
    "an inherited method is missing": ("IsSingularity", "IsOdd", "lacks the method IsSingularity"),
    "the property is missing": ("NumAxes", "NumberAxes", "lacks the property NumAxes"),
    "the property has another type": ("NumAxes : UDINT", "NumAxes : UINT", "is a UDINT"),
    "another result": ("GetConfigurationDataSize : INT", "GetConfigurationDataSize : DINT", "returns INT, not DINT"),
    "another length of a string": (
        "GetKinematicsName : STRING(255)",
        "GetKinematicsName : STRING(80)",
        "returns STRING",
    ),
    "a private method": ("METHOD PUBLIC IsInitialized", "METHOD PRIVATE IsInitialized", "must be public"),
    "another parameter name": ("cdSrc", "cdSource", "cdsrc"),
    "another parameter type": ("    udiAxis : UDINT;", "    udiAxis : UINT;", "UDINT"),
    "another order": (
        "    aRef : TRAFO.AXISPOS_REF;\n    cd : TRAFO.CONFIGDATA;",
        "    cd : TRAFO.CONFIGDATA;\n    aRef : TRAFO.AXISPOS_REF;",
        "is wanted",
    ),
    "one parameter more": (
        "    udiAxis : UDINT;",
        "    udiAxis : UDINT;\n    udiMore : UDINT;",
        "has 2 parameters, not 3",
    ),
    "another scope": ("VAR_IN_OUT CONSTANT\n    cd1 :", "VAR_IN_OUT\n    cd1 :", "is wanted"),
}


@pytest.mark.parametrize("name", CONTRACT)
def test_a_broken_contract_is_refused(name: str) -> None:
    """A block that lacks or changes a method of its interface is refused."""
    right, wrong, message = CONTRACT[name]
    # A renamed thing is renamed everywhere; otherwise only the first place changes.
    renamed = "lacks" in message or message == "cdsrc"
    text = TEXT.replace(right, wrong) if renamed else TEXT.replace(right, wrong, 1)
    assert text != TEXT
    with pytest.raises(StError, match=message):
        compile_st({FILE.name: text})
