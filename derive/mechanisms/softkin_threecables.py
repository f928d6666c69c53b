"""Softkin_ThreeCables: three cables, wound from anchors anywhere, hold one point."""

from derive.reach import three_to_a_point

MECHANISM = three_to_a_point(
    "Softkin_ThreeCables",
    what="cable",
    anchors=((0.0, 2000.0, 2500.0), (-1800.0, -1000.0, 2400.0), (1800.0, -1000.0, 2600.0)),
    nominal=2600.0,
    hangs=True,
    source="cable robots whose load hangs from three winches (P_3L)",
    summary="Cable robot: three cables, wound from anchors anywhere, hold one point.",
)
