"""The method of each program: the arguments that it unpacks, and the shape of its result."""

from __future__ import annotations

from derive.emit.python.calls import GIVEN
from derive.emit.python.program import Argument, Method, Shape
from derive.equations.limits import value_of
from derive.ir.passes import normalise
from derive.ir.program import Output
from derive.ir.symbols import branch_sign
from derive.kinematics.differential import TWIST_ROWS
from derive.kinematics.kinematics import Kinematics

POSITION: tuple[Shape, ...] = ("x", "y", "z")
ROTATION: tuple[Shape, ...] = tuple(tuple(f"r{row}{column}" for column in "123") for row in "123")
OFFSET: tuple[Shape, ...] = ("point_x", "point_y", "point_z")
IMAGE: tuple[Shape, ...] = (
    tuple(tuple(f"zero_r{row}{column}" for column in "123") for row in "123"),
    ("rot_x", "rot_y", "rot_z"),
    ("u_x", "u_y", "u_z"),
)
ROTATION_ARGUMENT = Argument("rotation", "Rotation", ROTATION)
_AXES = tuple(Argument(name, "Vector", tuple(f"{name}_{c}" for c in "xyz")) for name in ("flange_axis", "base_axis"))


def methods(kin: Kinematics) -> list[Method]:
    """The methods of the generated class that are programs, in the order of their use."""
    axes = _axes(kin)
    axis_values = axes.shape
    branch_margins = _branch_margins(kin)
    found = [
        *shared(kin),
        *every_root(kin),
        forward(kin),
        Method("orientation", "The rotation of the frame.", kin.orientation, (axes,), "Rotation", ROTATION),
        branch(kin),
        limits(kin),
        *differential(kin),
        *_quantities(kin),
        Method("image", "The orientations of the flange.", kin.image, (), "Image", IMAGE),
        *_compatible(kin),
        *end_point_shift(kin),
        *_total_image(kin),
        *projection(kin),
    ]
    offset = Argument("offset", "Vector", OFFSET)
    if kin.offset_branch is not None:
        text = "The axes of one branch for a point off the flange."
        arguments = (Argument("point", "Vector", POSITION), offset, *_choice(kin))
        found.append(
            Method("offset_branch", text, kin.offset_branch, arguments, "Reals", axis_values, is_explained=True)
        )
    if kin.offset_configuration is not None:
        text = "The signed margin of every branch for a point off the flange."
        found.append(Method("offset_margins", text, kin.offset_configuration, (axes, offset), "Reals", branch_margins))
    return found


def shared(kin: Kinematics) -> list[Method]:
    """The methods of the programs that others call: argument and result are one tuple each."""
    constants = {o.name for o in kin.setup.outputs}
    found: list[Method] = []
    for program in kin.shared:
        given = Argument(GIVEN, "Values", tuple(s.name for s in program.inputs if s.name not in constants))
        outputs = tuple(o.name for o in program.outputs)
        found.append(Method(program.name, f"{program.summary}.", program, (given,), "Values", outputs, is_shared=True))
    return found


def every_root(kin: Kinematics) -> list[Method]:
    """The methods around a search for all roots: the arguments of the search, and the axes of the joints it finds."""
    if kin.search_given is None or kin.from_joints is None:
        return []
    pose = (Argument("position", "Vector", POSITION), Argument("rotation", "Rotation", ROTATION))
    joints = Argument("joints", "Reals", tuple(j.symbol.name for j in kin.mechanism.joints))
    given = tuple(o.name for o in kin.search_given.outputs)
    return [
        Method("search_given", "Arguments of the search.", kin.search_given, (*pose, *_choice(kin)), "Values", given),
        Method(
            "from_joints",
            "The axis values of joint values.",
            kin.from_joints,
            (joints, *_choice(kin)[1:]),
            "Reals",
            _axes(kin).shape,
        ),
    ]


def forward(kin: Kinematics) -> Method:
    """Forward kinematics."""
    result = (POSITION, ROTATION, _branch_margins(kin))
    text = "Position, rotation and the signed margin of every branch."
    return Method("forward", text, kin.forward, (_axes(kin),), "Pose", result)


def branch(kin: Kinematics) -> Method:
    """Inverse kinematics on one branch."""
    pose = (Argument("position", "Vector", POSITION), Argument("rotation", "Rotation", ROTATION))
    text = "The axes of one branch, on their turns; limits are not tested."
    return Method("branch", text, kin.branch, (*pose, *_choice(kin)), "Reals", _axes(kin).shape, is_explained=True)


def rows_of_twist(kin: Kinematics) -> tuple[int, ...]:
    """The rows of the twist that the Jacobian has; nothing where the Jacobian has a program of its own."""
    if kin.twist is None or not set(kin.rows) <= set(TWIST_ROWS):
        return ()
    return tuple(map(TWIST_ROWS.index, kin.rows))


def differential(kin: Kinematics) -> list[Method]:
    """The margins, all rows of the twist where the Jacobian lacks rows that are not zero, and the Jacobian where its
    rows are no rows of the twist.
    """
    axes, margins = _axes(kin), tuple(m.name for m in kin.margins)
    text = "The margins, each zero at its singularity."
    found = [Method("singularity", text, kin.singularity, (axes,), "Reals", margins)]
    if not rows_of_twist(kin):
        text = "The Jacobian by rows, per radian."
        found.append(Method("jacobian", text, kin.jacobian, (axes,), "Matrix", _rows(kin, len(kin.rows))))
    if kin.twist is not None:
        text = "The twist of the frame by rows, per radian."
        found.append(Method("twist", text, kin.twist, (axes,), "Matrix", _rows(kin, len(TWIST_ROWS))))
    return found


def projection(kin: Kinematics) -> list[Method]:
    """The projection of the commanded rotation, where the mechanism follows a turn alone."""
    if kin.projection is None or not kin.chooses_twist:
        return []
    text = "The nearest rotation that the flange can have."
    return [Method("projection", text, kin.projection, (ROTATION_ARGUMENT,), "Rotation", ROTATION)]


def _rows(kin: Kinematics, count: int) -> tuple[Shape, ...]:
    """The entries of a matrix with a column for each axis."""
    return tuple(tuple(f"j{i}{k}" for k, _ in enumerate(kin.mechanism.joints, 1)) for i in range(1, count + 1))


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


def limits(kin: Kinematics) -> Method:
    """The test of all limits."""
    return Method("limits", "The test of the limits.", kin.limits, (_axes(kin),), "", (), is_explained=True)


def _quantities(kin: Kinematics) -> list[Method]:
    """The quantities other than axes that have limits, as the test of the limits computes them."""
    if not kin.limited:
        return []
    names = [value_of(quantity) for quantity in kin.limited]
    program = normalise("quantities", kin.limits.lets(), [Output(name.name, name) for name in names])
    text = "The quantities beside the axes that have limits."
    return [Method("quantities", text, program, (_axes(kin),), "Reals", tuple(n.name for n in names))]


def _axes(kin: Kinematics) -> Argument:
    return Argument("axes", "Reals", tuple(j.axis.name for j in kin.mechanism.joints))


def _branch_margins(kin: Kinematics) -> tuple[Shape, ...]:
    return tuple(f"branch_{b.name}" for b in kin.branches)


def _choice(kin: Kinematics) -> tuple[Argument, ...]:
    return (
        Argument("signs", "Signs", tuple(branch_sign(b.name).name for b in kin.branches)),
        Argument("turns", "Turns", tuple(j.turn.name for j in kin.period_joints)),
        Argument("reference", "Reals", tuple(j.reference.name for j in kin.mechanism.joints)),
    )
