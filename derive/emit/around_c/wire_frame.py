"""The wire frame of a machine: the lines of its drawing at any pose, as a function in C and a table of edges."""

from __future__ import annotations

from dataclasses import dataclass, replace

from derive.description.mechanism import DescriptionError
from derive.drawing.parts import wire_frame_of
from derive.emit.c.description import inputs
from derive.emit.c.functions import Function
from derive.emit.c.printer import laid_out, list_of
from derive.emit.c.program import function_lines
from derive.emit.interface import POSE, Entry
from derive.emit.setup import with_constants
from derive.kinematics.kinematics import Kinematics
from derive.report.reasons import reasons_of

MOST_EDGES = 16


@dataclass(frozen=True)
class WireFrame:
    """The edges of a machine."""

    function: str
    """Its text: it computes all points."""
    edges: tuple[str, ...]
    """Of each the numbers of its points, -1 for the tool."""


def wire_frame(kin: Kinematics, module: str) -> WireFrame | None:
    """The first lines of the drawing, as many as a controller takes; None if the machine has no drawing."""
    try:
        parts, drawn = wire_frame_of(kin)
    except DescriptionError:  # a drawing is no part of the proof
        return None
    axes = tuple(joint.axis.name for joint in kin.mechanism.joints)
    summary, results = "The points of the drawing.", (("points", parts.names),)
    entry = Entry("parts", summary, parts.program, (("axes", axes), *POSE), results)
    # the function has parameters alone, and computes what depends on them
    entry = replace(entry, program=with_constants(parts.program, kin, entry.given | inputs(kin).names.keys()))
    stored = {inner: f"k->{name}" for inner, name in inputs(kin).names.items()}
    lines = function_lines(Function(entry), f"{module}_parameters", stored, reasons_of(kin))
    edges = [list_of(map(str, ends)) for *ends, _ in drawn]
    return WireFrame("\n".join(laid_out(lines)), tuple(edges[:MOST_EDGES]))
