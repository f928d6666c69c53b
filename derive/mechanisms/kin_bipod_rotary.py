"""Kin_Bipod_Rotary: two arms and a plate in the X-Y plane, the machine of Kin_P2C_Type1."""

from dataclasses import replace

from derive.mechanism import Vendor
from derive.mechanisms.kin_p2c_type1 import MECHANISM as P2C_TYPE1

MECHANISM = replace(
    P2C_TYPE1,
    name="Kin_Bipod_Rotary",
    vendor=Vendor.CODESYS,
    source=(
        "CODESYS SM3_Transformation lists Kin_Bipod_Rotary without a geometry: as Kin_P2C_Type1, Softkin's definition"
    ),
    summary="Bipod: two arms carry a plate that keeps its orientation, in the X-Y plane.",
)
