"""Softkin_CylinderPalletizer: a palletizer whose arms two cylinders move, both with their pins on the column."""

from sympy import cos, sin

from derive.frames import Ry, Rz, Tx, Tz
from derive.mechanism import (
    Mechanism,
    Task,
    Turning,
    Vendor,
    branch,
    coordinate,
    distance,
    driven,
    length,
    linear,
    rotary,
)

HEIGHT = distance("base_height", "Height of the rear arm's pin above the base", nominal=500.0)
BESIDE = distance("shoulder_offset", "Axis A1 to the rear arm's pin, forward", nominal=150.0)
L1 = length("link_length_1", "Rear arm, its pin to the elbow", nominal=700.0)
L2 = length("link_length_2", "Forearm, elbow to the level wrist", nominal=800.0)
WRIST = distance("wrist_offset_x", "Wrist to axis A4, forward", nominal=120.0)
DROP = distance("wrist_offset_z", "Wrist to the flange, along Z, downward negative", nominal=-90.0)

BASE_X = coordinate("cylinder_2_x", "Pin of cylinder S2 on the column, forward", nominal=-420.0)
BASE_Z = coordinate("cylinder_2_z", "Pin of cylinder S2 on the column, up", nominal=60.0)
EYE = length("cylinder_eye", "Pin of cylinder S2 on the rear arm, along it", nominal=380.0)
PIN_X = coordinate("cylinder_3_x", "Pin of cylinder S3 on the column, forward", nominal=-300.0)
PIN_Z = coordinate("cylinder_3_z", "Pin of cylinder S3 on the column, up", nominal=-450.0)
LEVER = length("lever_length", "Lever of the forearm's parallelogram, backward from the rear arm's pin", nominal=250.0)

REAR = rotary("B", "Rear arm: zero upright, positive forward", nominal=15.0)
FOREARM = rotary("C", "Forearm, against the base: zero level, positive downward", nominal=10.0)

A1 = rotary("A1", "Column about Z")
S2 = linear("S2", "Cylinder of the rear arm: its length", nominal=601.0)
S3 = linear("S3", "Cylinder of the forearm: its length", nominal=496.4)
A4 = rotary("A4", "Flange about Z")

OUT = BESIDE + L1 * sin(REAR) + L2 * cos(FOREARM) + WRIST

MECHANISM = Mechanism(
    name="Softkin_CylinderPalletizer",
    vendor=Vendor.TEXTBOOK,
    family="articulated",
    source="palletizing robots with linear drives; where the cylinders stand is Softkin's definition",
    summary="Palletizer: a cylinder moves the rear arm, another the forearm, both from the column.",
    parameters=(HEIGHT, BESIDE, L1, L2, WRIST, DROP, BASE_X, BASE_Z, EYE, PIN_X, PIN_Z, LEVER),
    joints=(A1, S2, S3, A4),
    chain=Rz(A1)
    * Tz(HEIGHT)
    * Tx(BESIDE)
    * Ry(REAR)
    * Tz(L1)
    * Ry(FOREARM - REAR)
    * Tx(L2)
    * Ry(-FOREARM)
    * Tx(WRIST)
    * Tz(DROP)
    * Rz(A4),
    drives=(
        driven(REAR, by=S2, start=Tx(BASE_X) * Tz(BASE_Z), tip=Ry(REAR) * Tz(EYE)),
        driven(FOREARM, by=S3, start=Tx(PIN_X) * Tz(PIN_Z), tip=Ry(FOREARM) * Tx(-LEVER)),
    ),
    task=Task("xyz", Turning.ABOUT_Z),
    branches=(
        branch("shoulder", OUT, front=+1, back=-1, margin="axis_a4_on_a1"),
        branch("elbow", cos(FOREARM - REAR), up=+1, down=-1),
    ),
    notes=("C is the angle of the forearm against the base: a parallelogram hands the turn of its lever on.",),
)
