"""Softkin_Tripod_Struts: three struts of variable length, anchored anywhere, carry one point."""

from derive.reach import three_to_a_point

MECHANISM = three_to_a_point(
    "Softkin_Tripod_Struts",
    what="strut",
    anchors=((0.0, 300.0, 0.0), (-260.0, -150.0, 0.0), (260.0, -150.0, 0.0)),
    nominal=600.0,
    hangs=False,
    source="tripods whose legs change their length",
    summary="Tripod: three struts of variable length, anchored anywhere, carry one point.",
)
