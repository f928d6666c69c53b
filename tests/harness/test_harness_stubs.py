"""The stand-ins of the libraries behave as documented."""

from typing import Any

import pytest

from tests.harness.contract import INTERFACES
from tests.harness.library import Library, compile_st

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
    """The product of two frames applies the right one first."""
    left, right = frame(lib, TURN_Z, 1.0, 2.0, 3.0), frame(lib, TURN_X, 10.0, 20.0, 30.0)
    product = lib.new("SMC_Frame")
    assert lib.function("SM3M.SMC_Frame_Mult")(product, left, right) is True
    # left(right(0)) = TURN_Z * (10, 20, 30) + (1, 2, 3)
    assert (product.vT.dX, product.vT.dY, product.vT.dZ) == (-19.0, 12.0, 33.0)
    assert lib.get_rotation(product.mR) == ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    lib.function("SMC_Frame_Mult")(left, left, right)
    assert left == product


def test_the_storage_order_shows_in_memory() -> None:
    """The elements of a matrix lie in memory in the chosen storage order."""
    for order, memory in (("rows", [0.0, -1.0]), ("columns", [0.0, 1.0])):
        lib = compile_st({}, order=order)
        assert frame(lib, TURN_Z, 0.0, 0.0, 0.0).mR.memory[:2] == memory


def test_the_angle_of_a_c_axis(lib: Library) -> None:
    """The function of the library for a C axis gives the angle of a rotation about Z."""
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
    """The number of bytes in a configuration can be chosen, to test blocks against smaller ones."""
    assert len(compile_st({}, max_config_data=7).new("CONFIGDATA").abyData) == 8


def test_every_base_of_an_interface_is_known() -> None:
    """Every interface that another one extends is declared."""
    for name, interface in INTERFACES.items():
        for base in interface["extends"]:
            assert base in INTERFACES, name
