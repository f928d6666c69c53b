"""The method of each program: the arguments that it unpacks, and the shape of its result."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from derive.description.mechanism import DescriptionError
from derive.drawing.parts import Parts, links_of, parts_of
from derive.emit import interface as of
from derive.emit.interface import POSITION, ROTATION, Arrays, Entry, Shape
from derive.emit.python.program import Argument, Method
from derive.ir.program import Program
from derive.kept import kept_by_identity
from derive.kinematics.bias import bias_names
from derive.kinematics.differential import TWIST_ROWS
from derive.kinematics.kinematics import Kinematics

IMAGE: tuple[Shape, ...] = (of.rotation_of("zero_"), ("rot_x", "rot_y", "rot_z"), ("u_x", "u_y", "u_z"))
ROTATION_ARGUMENT = Argument("rotation", "Rotation", ROTATION)
_POINT = Argument("point", "Vector", POSITION)
_OFFSET = Argument("offset", "Vector", ("point_x", "point_y", "point_z"))
_ON_FLANGE = tuple(
    Argument(name, "Vector", tuple(f"{name}_{c}" for c in "xyz")) for name in ("flange_axis", "base_axis")
)
_KINDS = {
    "position": "Vector", "rotation": "Rotation", "signs": "Signs", "turns": "Turns",
    "given": "Values", "found": "Values", "rows": "Matrix",
}  # fmt: skip
"""The types of arrays; any other is `Reals`."""
_EXPLAINED = ("branch", "limits", "offset_branch")
"""The programs that refuse with a reason."""
_ORDER = """
    search_given from_joints forward orientation branch limits singularity jacobian twist bias twist_bias quantities
    image compatible end_point_shift total_image projection offset_branch offset_margins points
""".split()
"""The order of their use."""
_ON_ARRAYS = (
    "forward", "branch", "limits", "singularity", "jacobian", "twist", "bias", "twist_bias", "projection",
    "end_point_shift",
)  # fmt: skip
"""The programs that there are on arrays, too."""


def methods(kin: Kinematics) -> list[Method]:
    """The methods of the generated class that are programs, in the order of their use."""
    found = named(kin)
    return [*_shared(kin), *(found[name] for name in _ORDER if name in found)]


def array_methods(kin: Kinematics) -> list[Method]:
    """The methods of the programs on arrays."""
    found = named(kin)
    return [*_shared(kin), *(found[name] for name in _ON_ARRAYS if name in found)]


def named(kin: Kinematics) -> dict[str, Method]:
    """The methods by their names, without those of shared programs."""
    found = {key: _method(entry) for key, entry in of.entries(kin).items()}
    if rows_of_twist(kin):  # the Jacobian consists of rows of the twist
        del found["jacobian"], found["bias"]
    return found | {method.name: method for method in _further(kin)}


def rows_of_twist(kin: Kinematics) -> tuple[int, ...]:
    """The rows of the twist that the Jacobian has; nothing if the Jacobian has a program of its own."""
    if kin.twist is None or not set(kin.rows) <= set(TWIST_ROWS):
        return ()
    return tuple(map(TWIST_ROWS.index, kin.rows))


def _further(kin: Kinematics) -> Iterator[Method]:
    """The programs that Python alone offers."""
    axes, choice = _arguments(of.axes_of(kin)), _arguments(of.choice_of(kin))
    axis_values, margins = of.axes_of(kin)[0][1], of.margins_of(kin)[0][1]
    projection = kin.projection if kin.chooses_twist else None
    twist, total = of.matrix_of(kin, len(TWIST_ROWS)), (*IMAGE, "apart")
    on_flange, point = (ROTATION_ARGUMENT, *_ON_FLANGE), (_POINT, _OFFSET, *choice)
    loop = drawn_loop(kin)
    drawn, points = (loop.program, tuple(name for row in loop.names for name in row)) if loop else (None, ())
    rows: tuple[tuple[str, str, Program | None, tuple[Argument, ...], str, Shape], ...] = (
        ("orientation", "The rotation of the frame.", kin.orientation, axes, "Rotation", ROTATION),
        ("twist", "The twist of the frame by rows, per radian.", kin.twist, axes, "Matrix", twist),
        ("twist_bias", "The acceleration of the twist where the axes keep their speeds, per radian.", kin.twist_bias,
         (*axes, *_arguments(of.speeds_of(kin))), "Reals", bias_names(TWIST_ROWS)),
        ("image", "The orientations of the flange.", kin.image, (), "Image", IMAGE),
        ("compatible", "Whether a flange that turns can carry this mechanism.", kin.compatible, _ON_FLANGE[:1], "", ()),
        ("end_point_shift", "The vector from a flange that turns to the end point.", kin.end_point_shift, on_flange,
         "Vector", POSITION),
        ("total_image", "The orientations of the tool on a flange, and the sine of the angle between the two axes.",
         kin.total_image, on_flange, "TotalImage", total),
        ("projection", "The nearest rotation that the flange can have.", projection, (ROTATION_ARGUMENT,),
         "Rotation", ROTATION),
        ("offset_branch", "The axes of one branch for a point off the flange.", kin.offset_branch, point, "Reals",
         axis_values),
        ("offset_margins", "The signed margin of every branch for a point off the flange.", kin.offset_configuration,
         (*axes, _OFFSET), "Reals", margins),
        ("points", "What is drawn: see `LINES`.", drawn, (*axes, *_arguments(of.POSE)), "Reals", points),
    )  # fmt: skip
    for name, summary, program, arguments, kind, result in rows:
        if program is not None:
            yield Method(name, summary, program, arguments, kind, result, is_explained=name in _EXPLAINED)


@kept_by_identity(2)
def drawn_loop(kin: Kinematics) -> Parts | None:
    """What is drawn of a machine with loops; None if there is no drawing, and for a chain without, whose links are."""
    if kin.mechanism.drives:
        return links_of(kin)
    try:
        return parts_of(kin) if kin.mechanism.chain is None else None
    except DescriptionError:  # a drawing is no part of the proof
        return None


def _shared(kin: Kinematics) -> list[Method]:
    """The methods of the programs that others call: argument and result are one tuple each."""
    return [replace(_method(e), name=e.program.name, is_shared=True) for e in of.shared_entries(kin, kin.shared)]


def _arguments(arrays: Arrays) -> tuple[Argument, ...]:
    return tuple(Argument(name, _KINDS.get(name, "Reals"), shape) for name, shape in arrays)


def _method(entry: Entry) -> Method:
    kinds = [(_KINDS.get(name, "Reals"), shape) for name, shape in entry.results]
    kind, result = ("Pose", tuple(shape for _, shape in kinds)) if len(kinds) > 1 else kinds[0] if kinds else ("", ())
    given, is_explained = _arguments(entry.arguments), entry.key in _EXPLAINED
    return Method(entry.key, entry.summary, entry.program, given, kind, result, is_explained=is_explained)
