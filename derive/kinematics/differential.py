"""The Jacobian, from A x' + B q' = 0."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from derive.description.mechanism import DescriptionError, Mechanism, Plane, Turning
from derive.equations.axes import Forward
from derive.equations.chain_splits import is_spatial
from derive.equations.closures.fixed_names import fixed_lets, with_fixed_names
from derive.equations.drives import rate
from derive.equations.named_pose import named_pose
from derive.equations.pitch.chain import followed_factors
from derive.equations.trigonometry import named_trigonometry
from derive.geometry.frames import Chain, Motion
from derive.geometry.pose import Screw, pose_of
from derive.ir.constants import FREE_ANGLE
from derive.ir.passes import normalise
from derive.ir.primitives import Select
from derive.ir.program import Call, Let, Output, Program, Require, Solve, Statement, Status
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import COORDINATE_NAMES, DETERMINANT, HEADING, ROTATION_ENTRIES, SCALE, cosine, real, sine
from derive.plate.legs import RADIUS, Leg, leg_symbol, legs_of, names, rotation_axes, rotation_of, rows
from derive.plate.newton import legs_at_pose
from derive.plate.surplus import MISS, miss_row, misses_of
from derive.work import stage

_ROWS = ("x", "y", "z", "turn x", "turn y", "turn z", "tilt x", "tilt y")
"""The rows of a twist: along and about the axes of the base, and about the x and y axes of the tool, which tilt its z
axis."""
TWIST_ROWS = _ROWS[:6]
"""The rows of a twist along and about the axes of the base."""
_END = sp.ImmutableMatrix([real(c) for c in COORDINATE_NAMES])
_FOLLOWED = ("pitch", "roll")
"""The rows of a twist about the axes of the turns that follow the commanded rotation, where the first turns do not."""
_TURNS: dict[Turning, tuple[str, ...]] = {
    Turning.PITCH: _FOLLOWED[:1],
    Turning.PITCH_ROLL: _FOLLOWED,
    Turning.NONE: (),
    Turning.ABOUT_Z: ("turn z",),
    Turning.DIRECTION: ("tilt x", "tilt y"),
    Turning.FULL: ("turn x", "turn y", "turn z"),
}


def jacobian_rows(mechanism: Mechanism) -> tuple[str, ...]:
    """The rows of the task: commanded positions, then the commanded rotation, then the misses of surplus rods."""
    own = (*mechanism.task.position, *_TURNS[mechanism.task.turning])
    return (*own, *map(miss_row, mechanism.surplus_joints))


def is_of_length(row: str) -> bool:
    """Whether a row of the Jacobian is in lengths: a coordinate, or the miss of a surplus rod."""
    return row in COORDINATE_NAMES or row.startswith(MISS)


@stage("the Jacobian")
def jacobian_program(mechanism: Mechanism, forward: Forward) -> Program:
    """The Jacobian: a row per quantity of the task, a column per axis; rotary axes per radian."""
    if mechanism.is_platform:
        return _platform_program("jacobian", jacobian_rows(mechanism), mechanism, forward)
    statements, values = jacobian_entries(mechanism)
    return normalise("jacobian", (*forward.statements, *statements), entries_of(values, len(mechanism.joints)))


def twist_program(mechanism: Mechanism, forward: Forward) -> Program:
    """All six rows of the twist, whatever the task: a coupling needs them."""
    width = len(mechanism.joints)
    if mechanism.chain is not None:
        lets, values = chain_entries(mechanism, TWIST_ROWS)
        return normalise("twist", (*forward.statements, *lets), entries_of(values, width))
    if mechanism.is_platform:
        return _platform_program("twist", TWIST_ROWS, mechanism, forward)
    solved, values = jacobian_entries(mechanism)
    own = {row: values[k * width : (k + 1) * width] for k, row in enumerate(jacobian_rows(mechanism))}
    entries = [e for row in TWIST_ROWS for e in own.get(row, [sp.Integer(0)] * width)]
    return normalise("twist", (*forward.statements, *solved), entries_of(entries, width))


def jacobian_entries(mechanism: Mechanism) -> tuple[tuple[Statement, ...], list[sp.Expr]]:
    """The statements for the Jacobian at a pose that forward kinematics has found, and its entries by rows."""
    if mechanism.chain is not None:
        return chain_entries(mechanism, jacobian_rows(mechanism))
    matrix, naming = _by_closure(mechanism)
    lets, values = _per_motor(mechanism, matrix)
    return (*naming, *lets), values


def chain_entries(
    mechanism: Mechanism, rows: Sequence[str], screws: Sequence[Screw] = ()
) -> tuple[tuple[Statement, ...], list[sp.Expr]]:
    """The statements and the entries of these rows for a chain. screws: those of the true chain of a machine that has
    deviations.
    """
    return _per_motor(mechanism, _by_screws(mechanism, rows, screws))


def solved_entries(mechanism: Mechanism) -> tuple[tuple[Statement, ...], list[sp.Expr]]:
    """`jacobian_entries` without the columns of the held joints."""
    lets, entries = jacobian_entries(mechanism)
    width = len(mechanism.joints)
    solved = [k for k, j in enumerate(mechanism.joints) if j in mechanism.solved_joints]
    return lets, [entries[row + k] for row in range(0, len(entries), width) for k in solved]


def scaled_entries(mechanism: Mechanism, entries: Sequence[sp.Expr]) -> tuple[sp.Expr, ...]:
    """The entries for the joints that are solved, with positions and slides in lengths of the machine."""
    joints = mechanism.solved_joints
    found = []
    for k, value in enumerate(entries):
        is_place, is_slide = k // len(joints) < len(mechanism.task.position), not joints[k % len(joints)].axis_is_angle
        power = int(is_slide) - int(is_place)
        found.append(value * SCALE**power)
    return tuple(found)


def _per_motor(mechanism: Mechanism, matrix: sp.Matrix) -> tuple[tuple[Statement, ...], list[sp.Expr]]:
    """The entries per velocity of a motor, with names for their sines and cosines."""
    rates = {k: rate(mechanism, j) for k, j in enumerate(mechanism.joints) if j.loops}
    motors = _motor_matrix(mechanism)
    for k, (_, value) in rates.items():
        motors[k, k] = value
    coupled = matrix * motors
    planar = mechanism.chain is not None and not is_spatial(mechanism.chain)
    entries = [sp.expand_mul(e) if planar else e for e in coupled]
    lets, values = named_trigonometry(mechanism, entries)
    return (*(s for statements, _ in rates.values() for s in statements), *lets), values


def entries_of(values: Sequence[sp.Expr], width: int) -> list[Output]:
    """The entries of a Jacobian, given by rows, as outputs."""
    return [Output(f"j{k // width + 1}{k % width + 1}", v) for k, v in enumerate(values)]


def _by_screws(mechanism: Mechanism, rows: Sequence[str], given: Sequence[Screw] = ()) -> sp.Matrix:
    """The Jacobian of a serial chain: every factor moves its end as a screw, times the derivative of the factor by the
    joint.
    """
    assert mechanism.chain is not None
    screws, position = (given, _END) if given else _screws(mechanism, mechanism.chain)
    columns = []
    for joint in mechanism.joints:
        column = sp.zeros(6, 1)
        for screw in screws:
            rate = sp.diff(screw.amount, joint.symbol)
            if rate != 0:
                column += rate * _twist(screw, position)
        columns.append(column)
    full = sp.Matrix.hstack(sp.zeros(6, 0), *columns)
    if mechanism.task.turning is Turning.DIRECTION:
        rotation = sp.Matrix(3, 3, list(ROTATION_ENTRIES))
        full = sp.Matrix.vstack(full, (rotation.T * full[3:, :])[:2, :])
    names = list(_ROWS[: full.rows])
    for name, place in zip(_FOLLOWED, _followed(mechanism), strict=False):
        full = sp.Matrix.vstack(full, sp.Matrix(screws[place].direction).T * full[3:6, :])
        names.append(name)
    return full.extract([names.index(row) for row in rows], list(range(full.cols)))


def _followed(mechanism: Mechanism) -> tuple[int, ...]:
    return followed_factors(mechanism) if mechanism.followed_turns else ()


def _screws(mechanism: Mechanism, chain: Chain) -> tuple[tuple[Screw, ...], sp.ImmutableMatrix]:
    """The screws of a chain and the position of its end; for a spatial chain in the names of its frames."""
    if is_spatial(chain):
        return named_pose(mechanism).screws, _END
    pose = pose_of(chain)
    return pose.screws, pose.position


def _twist(screw: Screw, position: sp.ImmutableMatrix) -> sp.Matrix:
    direction = sp.Matrix(screw.direction)
    if screw.motion is Motion.SHIFT:
        return sp.Matrix.vstack(direction, sp.zeros(3, 1))
    return sp.Matrix.vstack(direction.cross(sp.Matrix(position - screw.origin)), direction)


def _by_closure(mechanism: Mechanism) -> tuple[sp.Matrix, tuple[Statement, ...]]:
    """The Jacobian of stated equations: -A^-1 B with A = dΦ/dx, B = dΦ/dq, by the adjugate; type 2 singular where det A
    = 0. A heading follows from the joints alone.
    """
    closure = sp.Matrix([with_fixed_names(mechanism, e) for e in mechanism.holding_equations])
    by_pose = closure.jacobian([real(c) for c in mechanism.task.position])
    heading = sp.Integer(0) if mechanism.heading is None else mechanism.heading
    turned = closure.xreplace({cosine(HEADING): sp.cos(heading), sine(HEADING): sp.sin(heading)})
    joints = [j.symbol for j in mechanism.joints]
    by_joints = turned.jacobian(joints)
    rows_of_heading = int(mechanism.heading is not None)
    own_row = sp.Matrix(rows_of_heading, len(joints), [sp.diff(heading, j) for j in joints * rows_of_heading])
    if by_pose.rows != by_pose.cols:
        raise DescriptionError(f"{by_pose.rows} closure equations for {by_pose.cols} commanded coordinates")
    matrix, statements = _solved(mechanism, by_pose, by_joints)
    misses, more = misses_of(mechanism, matrix)
    return matrix.col_join(own_row).col_join(misses), (*statements, *more)


def _solved(mechanism: Mechanism, by_pose: sp.Matrix, by_joints: sp.Matrix) -> tuple[sp.Matrix, tuple[Statement, ...]]:
    """-A^-1 B. Coordinates with numeric coefficients alone (z of a quill) are solved first, without a divisor."""
    first = [k for k in range(by_pose.rows) if not by_pose.row(k).free_symbols]
    held = [c for c in range(by_pose.cols) if any(by_pose[k, c] != 0 for k in first)]
    if len(held) != len(first):
        first = held = []
    others, left = ([k for k in range(by_pose.rows) if k not in own] for own in (first, held))
    every = list(range(by_joints.cols))
    known = -by_pose.extract(first, held).inv() * by_joints.extract(first, every) if first else sp.zeros(0, len(every))
    rest = by_joints.extract(others, every) + by_pose.extract(others, held) * known
    statements: tuple[Statement, ...] = ()
    if others:
        rest, statements = _by_adjugate(mechanism, by_pose.extract(others, left), rest, (others, left))
    rows = dict(zip((*held, *left), (*known.tolist(), *rest.tolist()), strict=True))
    return sp.Matrix([rows[c] for c in range(by_pose.cols)]), statements


def _by_adjugate(
    mechanism: Mechanism, by_pose: sp.Matrix, by_joints: sp.Matrix, places: tuple[list[int], list[int]]
) -> tuple[sp.Matrix, tuple[Statement, ...]]:
    """-A^-1 B with a determinant that may vanish. places: the numbers of the equations and of the coordinates."""
    equations, coordinates = places
    entries, lets = _entries(mechanism, by_pose, [mechanism.task.position[c] for c in coordinates], equations)
    joints = [j.symbol.name if j.key in COORDINATE_NAMES else j.key for j in mechanism.joints]
    drives, more = _entries(mechanism, by_joints, joints, equations)
    determinant, divisor = real("determinant"), real("determinant_divisor")
    determined = sp.Gt(sp.Abs(determinant), FREE_ANGLE * SCALE**by_pose.rows)
    statements: tuple[Statement, ...] = (
        *lets,
        *more,
        Let(determinant, entries.det(), "determinant dPhi/dx: zero in a type 2 singularity"),
        Require(determined, Status.IMPOSSIBLE, reason=about_machine(Why.UNCONTROLLED)),
        Let(divisor, Select(determined, determinant, sp.Integer(1))),
    )
    return -entries.adjugate() * drives / divisor, statements


def _entries(
    mechanism: Mechanism, matrix: sp.Matrix, names: Sequence[str], equations: Sequence[int]
) -> tuple[sp.Matrix, tuple[Let, ...]]:
    """The entries of a matrix of derivatives, under the names `slope_<equation>_by_<unknown>`."""
    trigonometric, values = named_trigonometry(mechanism, list(matrix))
    lets: list[Let] = [*trigonometric]
    entries = []
    for k, value in enumerate(values):
        if value != 0:
            lets.append(Let(real(f"slope_{equations[k // matrix.cols] + 1}_by_{names[k % matrix.cols]}"), value))
        entries.append(lets[-1].name if value != 0 else sp.Integer(0))
    return sp.Matrix(matrix.rows, matrix.cols, entries), tuple(lets)


def _motor_matrix(mechanism: Mechanism) -> sp.Matrix:
    """The derivative of the joints by the motors: the identity and the gear couplings."""
    motors = [j.motor for j in mechanism.joints]
    return sp.Matrix(
        len(motors), len(motors), [sp.diff(j.ratio * j.motor + j.coupling, m) for j in mechanism.joints for m in motors]
    )


def _platform_program(name: str, rows: Sequence[str], mechanism: Mechanism, forward: Forward) -> Program:
    """Rows of A^-1 (-B) at a pose that forward kinematics has found."""
    motors = _motor_matrix(mechanism)
    solved, twists = _platform_twists(mechanism, motors)
    known = _by_rows(mechanism, twists, motors.cols)
    missed, lets = misses_of(mechanism, sp.Matrix(len(twists) // motors.cols, motors.cols, twists), motors)
    known |= dict(zip(map(miss_row, mechanism.surplus_joints), missed.tolist(), strict=True))
    entries = [e for row in rows for e in known.get(row, [sp.Integer(0)] * motors.cols)]
    return normalise(name, (*forward.statements, *solved, *lets), entries_of(entries, motors.cols))


def platform_velocities(
    mechanism: Mechanism, forward: Forward
) -> tuple[tuple[Statement, ...], dict[sp.Symbol, sp.Expr], dict[str, sp.Expr]]:
    """The statements for the velocity of a platform from the speeds of its axes, the rates of its pose, and the rows of
    its twist. The rows of A are made of the pose that was found, so that they can be differentiated.
    """
    lines = legs_at_pose(mechanism)
    bound = {let.name for let in lines}
    found = (
        replace(s, names=tuple(n for n in s.names if n not in bound)) if isinstance(s, Call) else s
        for s in forward.statements
    )
    speeds = _motor_matrix(mechanism) * sp.Matrix([j.speed for j in mechanism.joints])
    solved, twists = _platform_twists(mechanism, speeds)
    position = mechanism.motion.position
    turning = dict(zip(rotation_axes(mechanism), twists[len(position) :], strict=True))
    spin = sp.Matrix([turning.get(c, sp.Integer(0)) for c in COORDINATE_NAMES])
    rotation = rotation_of(mechanism)
    turned = sp.Matrix.hstack(*[spin.cross(rotation.col(k)) for k in range(3)])
    rates = zip((*map(real, position), *rotation), (*twists[: len(position)], *turned), strict=True)
    moving = {name: rate for name, rate in rates if name.is_Symbol}
    joints = [j.symbol for j in mechanism.joints]
    # The length of a rod is what its joint says: it is never too short at a pose that was found.
    for rod in mechanism.holding_rods:
        (changed,) = sp.Matrix([with_fixed_names(mechanism, rod.length)]).jacobian(joints) * speeds
        moving |= {leg_symbol("divisor", rod): changed} if changed != 0 else {}
    missed, lets = misses_of(mechanism, sp.Matrix(twists), speeds)
    rows_found = {row: e for row, (e,) in _by_rows(mechanism, twists, 1).items()}
    rows_found |= dict(zip(map(miss_row, mechanism.surplus_joints), missed, strict=True))
    return (*found, *lines, *solved, *lets), moving, rows_found


def _platform_twists(mechanism: Mechanism, motors: sp.Matrix) -> tuple[tuple[Statement, ...], list[sp.Expr]]:
    """The twists of the platform, by rows: a column for each column of the motors."""
    joints = [j.symbol for j in mechanism.joints]
    driven = sp.Matrix([_driven(mechanism, leg).jacobian(joints) for leg in legs_of(mechanism)]) * motors
    lets, named = named_trigonometry(mechanism, list(driven))
    width, shifts = motors.cols, len(mechanism.motion.position)
    words = (*(f"v{c}" for c in mechanism.motion.position), *(f"w{c}" for c in rotation_axes(mechanism)))
    entries = [real(f"column_{column}_{word}") for word in words for column in range(1, width + 1)]
    held = Require(sp.Gt(sp.Abs(DETERMINANT), FREE_ANGLE), Status.IMPOSSIBLE, reason=about_machine(Why.UNCONTROLLED))
    system = Solve(
        tuple(entries), rows(mechanism), tuple(named), None, "twist of the platform per velocity of each axis"
    )
    values = [e if k // width < shifts else e / RADIUS for k, e in enumerate(entries)]
    return (held, *fixed_lets(mechanism), *lets, system), values


def _by_rows(mechanism: Mechanism, twists: Sequence[sp.Expr], width: int) -> dict[str, list[sp.Expr]]:
    """The twists of the platform by the names of their rows, also about the axes of the tool, where it turns freely."""
    matrix = sp.Matrix(len(twists) // width, width, list(twists))
    names = [*mechanism.motion.position, *(f"turn {c}" for c in rotation_axes(mechanism))]
    found = {name: list(matrix.row(k)) for k, name in enumerate(names)}
    if mechanism.motion.turning is Turning.FULL:
        tilts = rotation_of(mechanism).T * matrix[len(mechanism.motion.position) :, :]
        found |= {name: list(tilts.row(k)) for k, name in enumerate(("tilt x", "tilt y"))}
    return found


def _driven(mechanism: Mechanism, leg: Leg) -> sp.Matrix:
    """The negative of a leg's residual as a function of the joints, at a constant direction: along . base + length; for
    a plane, its offset.
    """
    if isinstance(leg, Plane):
        return sp.Matrix([with_fixed_names(mechanism, leg.offset)])
    ahead = sum((a * b for a, b in zip(names("along", leg), leg.base, strict=True)), leg.length)
    return sp.Matrix([with_fixed_names(mechanism, ahead)])
