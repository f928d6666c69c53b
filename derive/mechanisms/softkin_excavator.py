"""Softkin_Excavator: swing, boom, stick and bucket; cylinders move the last three, the bucket over a four-bar."""

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

FORWARD = distance("boom_foot_x", "Axis A1 to the foot of the boom, forward", nominal=300.0)
HEIGHT = distance("boom_foot_z", "Height of the foot of the boom", nominal=800.0)
BOOM = length("boom_length", "Foot of the boom to the stick", nominal=1800.0)
STICK = length("stick_length", "Boom to the bucket", nominal=1100.0)
BUCKET = length("bucket_length", "Pin of the bucket to its teeth", nominal=600.0)

BASE_X = coordinate("boom_cylinder_base_x", "Lower pin of the boom's cylinder, before the foot", nominal=250.0)
BASE_Z = coordinate("boom_cylinder_base_z", "Lower pin of the boom's cylinder, above the foot", nominal=-350.0)
EYE_X = coordinate("boom_cylinder_eye_x", "Upper pin of the boom's cylinder, along the boom", nominal=900.0)
EYE_Z = coordinate("boom_cylinder_eye_z", "Upper pin of the boom's cylinder, above the boom", nominal=-150.0)
BACK = coordinate("stick_cylinder_base_x", "Pin of the stick's cylinder on the boom, along it", nominal=-1000.0)
ABOVE = coordinate("stick_cylinder_base_z", "Pin of the stick's cylinder on the boom, above it", nominal=350.0)
TAIL_X = coordinate("stick_cylinder_eye_x", "Pin on the tail of the stick, along the stick", nominal=-250.0)
TAIL_Z = coordinate("stick_cylinder_eye_z", "Pin on the tail of the stick, above the stick", nominal=100.0)
START_X = coordinate("bucket_cylinder_base_x", "Pin of the bucket's cylinder, from the bucket's pin", nominal=-900.0)
START_Z = coordinate("bucket_cylinder_base_z", "Pin of the bucket's cylinder, above the stick", nominal=200.0)
PIVOT = coordinate("rocker_pivot_x", "Pin of the rocker, along the stick from the bucket's pin", nominal=-220.0)
ROCKER = length("rocker_length", "Rocker: its pin to the cylinder and the rod", nominal=200.0)
ROD = length("rod_length", "Rod from the rocker to the bucket", nominal=276.0)
EAR_X = coordinate("bucket_ear_x", "Pin of the rod on the bucket, towards the teeth", nominal=-60.0)
EAR_Z = coordinate("bucket_ear_z", "Pin of the rod on the bucket, above that line", nominal=140.0)

BOOM_ANGLE = rotary("B", "Boom against the ground, positive downward", nominal=-40.0)
STICK_ANGLE = rotary("C", "Stick against the boom, positive downward", nominal=80.0)
ROCKER_ANGLE = rotary("R", "Rocker against the stick", nominal=-100.0)
BUCKET_ANGLE = rotary("D", "Bucket against the stick, positive inward", nominal=30.0)

A1 = rotary("A1", "Swing about Z")
S2 = linear("S2", "Cylinder of the boom: its length", nominal=974.0)
S3 = linear("S3", "Cylinder of the stick: its length", nominal=1058.0)
S4 = linear("S4", "Cylinder of the bucket: its length", nominal=645.0)

AT_ROCKER = Tx(PIVOT) * Ry(ROCKER_ANGLE) * Tx(ROCKER)

TURNED = BOOM_ANGLE + STICK_ANGLE
OUT = FORWARD + BOOM * cos(BOOM_ANGLE) + STICK * cos(TURNED) + BUCKET * cos(TURNED + BUCKET_ANGLE)

MECHANISM = Mechanism(
    name="Softkin_Excavator",
    vendor=Vendor.TEXTBOOK,
    family="articulated",
    source="backhoe excavators: boom, stick and bucket",
    summary="Excavator: cylinders move boom, stick and bucket, the bucket over a rocker and a rod.",
    parameters=(
        *(FORWARD, HEIGHT, BOOM, STICK, BUCKET, BASE_X, BASE_Z, EYE_X, EYE_Z, BACK, ABOVE, TAIL_X, TAIL_Z),
        *(START_X, START_Z, PIVOT, ROCKER, ROD, EAR_X, EAR_Z),
    ),
    joints=(A1, S2, S3, S4),
    chain=Rz(A1)
    * Tx(FORWARD)
    * Tz(HEIGHT)
    * Ry(BOOM_ANGLE)
    * Tx(BOOM)
    * Ry(STICK_ANGLE)
    * Tx(STICK)
    * Ry(BUCKET_ANGLE)
    * Tx(BUCKET),
    drives=(
        driven(BOOM_ANGLE, by=S2, start=Tx(BASE_X) * Tz(BASE_Z), tip=Ry(BOOM_ANGLE) * Tx(EYE_X) * Tz(EYE_Z)),
        driven(STICK_ANGLE, by=S3, start=Tx(BACK) * Tz(ABOVE), tip=Ry(STICK_ANGLE) * Tx(TAIL_X) * Tz(TAIL_Z)),
        driven(ROCKER_ANGLE, by=S4, start=Tx(START_X) * Tz(START_Z), tip=AT_ROCKER),
        driven(
            BUCKET_ANGLE, by=ROCKER_ANGLE, start=AT_ROCKER, tip=Ry(BUCKET_ANGLE) * Tx(EAR_X) * Tz(EAR_Z), length=ROD
        ),
    ),
    task=Task("xyz", Turning.PITCH),
    branches=(
        branch("shoulder", OUT, front=+1, back=-1, margin="teeth_on_a1"),
        branch("elbow", sin(STICK_ANGLE), stick_down=+1, stick_up=-1),
    ),
)
