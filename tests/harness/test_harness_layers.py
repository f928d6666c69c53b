"""The harness itself: its layers, its marks, and its stand-ins for the library."""

from typing import Any

import pytest

from tests.harness.contract import INTERFACES
from tests.harness.layers import Texts, _at_once, layer_of
from tests.harness.library import Library, StError, compile_st

FIRST = """
FUNCTION First : INT
VAR_INPUT n : INT; END_VAR
First := n + 1;
END_FUNCTION
"""
LAST = """
FUNCTION Last : INT
VAR_INPUT n : INT; END_VAR
Last := First(n := n) * 2;
END_FUNCTION
"""
KIND = "TYPE Kind : (Rotary, Skew); END_TYPE"
KINDS = """
FUNCTION IsRotary : BOOL
VAR_INPUT given : Axis_Type; END_VAR
IsRotary := given = Rotary;
END_FUNCTION
"""


@pytest.mark.parametrize("texts", [(("first", FIRST), ("last", LAST)), (("last", LAST), ("first", FIRST))])
def test_whichever_comes_last_the_translation_is_that_of_all_at_once(texts: Texts) -> None:
    assert layer_of(texts, 72, 31).whole() == _at_once(texts, 72, 31).whole()
    assert compile_st(dict(texts)).function("Last")(n=3) == 8


@pytest.mark.parametrize("last", [FIRST.replace("First", "FIRST"), "VAR_GLOBAL first : INT; END_VAR"])
def test_a_name_that_the_others_have_is_refused(last: str) -> None:
    with pytest.raises(StError, match="duplicate name"):
        compile_st({"first": FIRST, "last": last})


def test_a_name_that_hides_another_is_seen_by_all() -> None:
    """The member of a list in the last text is what the first text means by that name."""
    texts = (("kinds", KINDS), ("kind", KIND))
    with pytest.raises(StError) as at_once:
        _at_once(texts, 72, 31)
    with pytest.raises(StError) as found:
        layer_of(texts, 72, 31)
    assert str(found.value) == str(at_once.value)


TEXT = """FUNCTION Walk : INT
VAR_INPUT
  count : INT;
END_VAR
VAR
  i : INT;
END_VAR
IF count < 0 THEN
  Walk := -1;
  RETURN;
ELSIF count = 0 THEN
  Walk := 0;
ELSE
  FOR i := 1 TO count DO
    Walk := Walk + i;
  END_FOR
  IF i > 100 THEN
    i := 100;
  END_IF
END_IF
CASE Walk OF
  1:
    Walk := 10;
  2, 3:
    Walk := 30;
ELSE
  ;
END_CASE
END_FUNCTION
"""
RAN = {
    -1: {8, 9, 10},
    0: {8, 11, 12, 21, 22, 24},
    1: {8, 11, 14, 15, 17, 21, 22, 23},
    2: {8, 11, 14, 15, 17, 21, 22, 24, 25},
}
"""The lines of the statements that run and of the labels that are tried, by what is given."""


@pytest.mark.parametrize("count", RAN)
def test_the_statements_that_ran(count: int) -> None:
    library = compile_st({"Walk.st": TEXT})
    walk = library.function("Walk")
    ran = library.flags()
    before = walk(count)
    with library.watched(ran):
        assert walk(count) == before
    places = [place for place, flag in zip(library.origin.places, ran[1:], strict=True) if flag]
    lines = {place.line for place in places if place is not None and place.file == "Walk.st"}
    assert lines - {1} == RAN[count]
    seen = sum(ran)
    ran[:] = library.flags()
    walk(count)
    assert seen and not any(ran)


TURN_Z = ((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
TURN_X = ((1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 1.0, 0.0))


@pytest.fixture(params=["rows", "columns"])
def lib(request: pytest.FixtureRequest) -> Library:
    return compile_st({}, order=request.param)


def frame(lib: Library, rows: Any, x: float, y: float, z: float) -> Any:
    made = lib.new("SM3M.SMC_Frame")
    lib.set_rotation(made.mR, rows)
    made.vT.dX, made.vT.dY, made.vT.dZ = x, y, z
    return made


def test_frames_are_chained_left_after_right(lib: Library) -> None:
    left, right = frame(lib, TURN_Z, 1.0, 2.0, 3.0), frame(lib, TURN_X, 10.0, 20.0, 30.0)
    product = lib.new("SMC_Frame")
    assert lib.function("SM3M.SMC_Frame_Mult")(product, left, right) is True
    # left(right(0)) = TURN_Z * (10, 20, 30) + (1, 2, 3)
    assert (product.vT.dX, product.vT.dY, product.vT.dZ) == (-19.0, 12.0, 33.0)
    assert lib.get_rotation(product.mR) == ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    lib.function("SMC_Frame_Mult")(left, left, right)
    assert left == product


def test_the_storage_order_shows_in_memory() -> None:
    for order, memory in (("rows", [0.0, -1.0]), ("columns", [0.0, 1.0])):
        lib = compile_st({}, order=order)
        assert frame(lib, TURN_Z, 0.0, 0.0, 0.0).mR.memory[:2] == memory


def test_the_angle_of_a_c_axis(lib: Library) -> None:
    turned = frame(lib, TURN_Z, 0.0, 0.0, 0.0)
    result, outputs = lib.function("CAxis_From_Orientation").with_outputs(turned.mR)
    assert (result, outputs["c_deg"]) == ("SMC_NO_ERROR", pytest.approx(90.0))


def test_orientation_images(lib: Library) -> None:
    """A fresh orientation image has unit axes, and the functions of the library set its degrees of freedom."""
    image, m = lib.new("TRAFO.OrientationSpace"), frame(lib, TURN_Z, 0.0, 0.0, 0.0).mR
    assert (image.vU.dX, image.vU.dY, image.vU.dZ) == (0.0, 0.0, 1.0)
    up, along = lib.new("SMC_Vector3D"), lib.new("SMC_Vector3D")
    up.dY, along.dX = 1.0, -1.0
    assert lib.function("Initialise_OriImage_dof1")(image, m, up, along) is True
    assert (image.dof, image.mOriZero, image.vU.dY, image.vRot.dX) == ("one", m, 1.0, -1.0)
    lib.function("Initialise_OriImage_dof0")(image, m)
    assert image.dof == "zero"
    lib.function("Initialise_OriImage_dof3")(image, m)
    assert image.dof == "three"


def test_the_capacity_of_the_configuration_can_be_chosen() -> None:
    assert len(compile_st({}, max_config_data=7).new("CONFIGDATA").abyData) == 8


def test_every_base_of_an_interface_is_known() -> None:
    for name, interface in INTERFACES.items():
        for base in interface["extends"]:
            assert base in INTERFACES, name
