"""The method of each program: the arguments that it unpacks, and the shape of its result."""

from __future__ import annotations

from dataclasses import replace

from derive.emit.interface import (
    POSITION,
    ROTATION,
    Arrays,
    Entry,
    Shape,
    axes_of,
    choice_of,
    entries,
    margins_of,
    matrix_of,
    rotation_of,
    shared_entries,
)
from derive.emit.python.program import Argument, Method
from derive.kinematics.differential import TWIST_ROWS
from derive.kinematics.kinematics import Kinematics

OFFSET: tuple[Shape, ...] = ("point_x", "point_y", "point_z")
IMAGE: tuple[Shape, ...] = (rotation_of("zero_"), ("rot_x", "rot_y", "rot_z"), ("u_x", "u_y", "u_z"))
ROTATION_ARGUMENT = Argument("rotation", "Rotation", ROTATION)
_AXES = tuple(Argument(name, "Vector", tuple(f"{name}_{c}" for c in "xyz")) for name in ("flange_axis", "base_axis"))
_KINDS = {
    "position": "Vector", "rotation": "Rotation", "signs": "Signs", "turns": "Turns",
    "given": "Values", "found": "Values", "rows": "Matrix",
}  # fmt: skip
"""The types of arrays; any other is `Reals`."""
_EXPLAINED = ("branch", "limits")
"""The programs that refuse with a reason."""


def methods(kin: Kinematics) -> list[Method]:
    """The methods of the generated class that are programs, in the order of their use."""
    axes = arguments(axes_of(kin))
    axis_values, branch_margins = (arrays[0][1] for arrays in (axes_of(kin), margins_of(kin)))
    found = [
        *shared(kin),
        *every_root(kin),
        forward(kin),
        Method("orientation", "The rotation of the frame.", kin.orientation, axes, "Rotation", ROTATION),
        branch(kin),
        limits(kin),
        *differential(kin),
        *_named(kin, "quantities"),
        Method("image", "The orientations of the flange.", kin.image, (), "Image", IMAGE),
        *_compatible(kin),
        *end_point_shift(kin),
        *_total_image(kin),
        *projection(kin),
    ]
    offset = Argument("offset", "Vector", OFFSET)
    if kin.offset_branch is not None:
        text = "The axes of one branch for a point off the flange."
        given = (Argument("point", "Vector", POSITION), offset, *arguments(choice_of(kin)))
        found.append(Method("offset_branch", text, kin.offset_branch, given, "Reals", axis_values, is_explained=True))
    if kin.offset_configuration is not None:
        text = "The signed margin of every branch for a point off the flange."
        found.append(Method("offset_margins", text, kin.offset_configuration, (*axes, offset), "Reals", branch_margins))
    return found


def arguments(arrays: Arrays) -> tuple[Argument, ...]:
    """The arguments of a method."""
    return tuple(Argument(name, _KINDS.get(name, "Reals"), shape) for name, shape in arrays)


def shared(kin: Kinematics) -> list[Method]:
    """The methods of the programs that others call: argument and result are one tuple each."""
    return [replace(_method(e), name=e.program.name, is_shared=True) for e in shared_entries(kin, kin.shared)]


def every_root(kin: Kinematics) -> list[Method]:
    """The methods around a search for all roots: the arguments of the search, and the axes of the joints it finds."""
    return _named(kin, "search_given", "from_joints")


def forward(kin: Kinematics) -> Method:
    """Forward kinematics."""
    return _method(entries(kin)["forward"])


def branch(kin: Kinematics) -> Method:
    """Inverse kinematics on one branch."""
    return _method(entries(kin)["branch"])


def limits(kin: Kinematics) -> Method:
    """The test of all limits."""
    return _method(entries(kin)["limits"])


def _named(kin: Kinematics, *keys: str) -> list[Method]:
    """The methods of these programs, of those that the machine has."""
    found = entries(kin)
    return [_method(found[key]) for key in keys if key in found]


def _method(entry: Entry) -> Method:
    kinds = [(_KINDS.get(name, "Reals"), shape) for name, shape in entry.results]
    kind, result = ("Pose", tuple(shape for _, shape in kinds)) if len(kinds) > 1 else kinds[0] if kinds else ("", ())
    given, is_explained = arguments(entry.arguments), entry.key in _EXPLAINED
    return Method(entry.key, entry.summary, entry.program, given, kind, result, is_explained=is_explained)


def rows_of_twist(kin: Kinematics) -> tuple[int, ...]:
    """The rows of the twist that the Jacobian has; nothing if the Jacobian has a program of its own."""
    if kin.twist is None or not set(kin.rows) <= set(TWIST_ROWS):
        return ()
    return tuple(map(TWIST_ROWS.index, kin.rows))


def differential(kin: Kinematics) -> list[Method]:
    """The margins, all rows of the twist where the Jacobian lacks rows that are not zero, and the Jacobian where its
    rows are no rows of the twist.
    """
    found = _named(kin, "singularity", *([] if rows_of_twist(kin) else ["jacobian"]))
    if kin.twist is not None:
        text, rows = "The twist of the frame by rows, per radian.", matrix_of(kin, len(TWIST_ROWS))
        found.append(Method("twist", text, kin.twist, arguments(axes_of(kin)), "Matrix", rows))
    return found


def projection(kin: Kinematics) -> list[Method]:
    """The projection of the commanded rotation, where the mechanism follows a turn alone."""
    if kin.projection is None or not kin.chooses_twist:
        return []
    text = "The nearest rotation that the flange can have."
    return [Method("projection", text, kin.projection, (ROTATION_ARGUMENT,), "Rotation", ROTATION)]


def end_point_shift(kin: Kinematics) -> list[Method]:
    """The vector to the end point of an orientation kinematics, on a flange that turns."""
    if kin.end_point_shift is None:
        return []
    text = "The vector from a flange that turns to the end point."
    return [Method("end_point_shift", text, kin.end_point_shift, (ROTATION_ARGUMENT, *_AXES), "Vector", POSITION)]


def _compatible(kin: Kinematics) -> list[Method]:
    if kin.compatible is None:
        return []
    text = "Whether a flange that turns can carry this mechanism."
    return [Method("compatible", text, kin.compatible, _AXES[:1], "", ())]


def _total_image(kin: Kinematics) -> list[Method]:
    if kin.total_image is None:
        return []
    text = "The orientations of the tool on a flange, and the sine of the angle between the two axes."
    return [Method("total_image", text, kin.total_image, (ROTATION_ARGUMENT, *_AXES), "TotalImage", (*IMAGE, "apart"))]
