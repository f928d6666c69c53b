"""Forward kinematics: from axis values to the pose, and the values of the inverse derivation at given axis values."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from derive.description.mechanism import Mechanism, Turning
from derive.equations.axes import Forward, finite, frozen_lets, joint_lets
from derive.equations.chain_splits import is_spatial
from derive.equations.closures.commanded import heading_of
from derive.equations.closures.fixed_names import all_angles, angles_of, fixed_lets, signs_of
from derive.equations.closures.stated import position_closure
from derive.equations.named_pose import named_pose
from derive.equations.problem import Problem
from derive.equations.trigonometry import heading_at_joints, named_trigonometry
from derive.geometry.pose import pose_of
from derive.ir.constants import BOUNDARY, LIMIT
from derive.ir.passes import normalise
from derive.ir.primitives import Select
from derive.ir.program import Let, Output, Program, Require, Statement, Status, rewritten
from derive.ir.reason import Why, about, about_machine
from derive.ir.symbols import (
    ASSEMBLY_SIGN,
    COORDINATE_NAMES,
    HEADING,
    OFFSET,
    ROTATION_ENTRIES,
    SCALE,
    cosine,
    real,
    sine,
)
from derive.kinematics.inverse import Inverse
from derive.plate.legs import about_z
from derive.plate.passive import at_the_pose
from derive.plate.surplus import miss_checks
from derive.plate.turning import forward_from_start
from derive.solver.derivation import Derivation
from derive.solver.solve import solve
from derive.work import counted


def pose_at_axes(mechanism: Mechanism) -> Forward:
    """The pose of a mechanism at its axis values. It requires the quantities to be positive that the description states
    to be positive.
    """
    if mechanism.is_platform:
        return forward_from_start(mechanism)
    checks = (*finite([j.axis for j in mechanism.joints if not j.free]), *joint_lets(mechanism), *_positive(mechanism))
    if mechanism.chain is not None and is_spatial(mechanism.chain):
        return _frame_by_frame(mechanism, checks)
    if mechanism.chain is not None:
        pose = pose_of(mechanism.chain)
        lets, values = named_trigonometry(mechanism, [*pose.position, *pose.rotation])
        position = tuple(Let(real(c), v) for c, v in zip(COORDINATE_NAMES, values[:3], strict=True))
        return Forward((*checks, *lets, *position), tuple(p.name for p in position), tuple(values[3:]))
    joints = angles_of(mechanism)
    trigonometric = tuple(Let(f(a), g(a)) for a in joints for f, g in ((cosine, sp.cos), (sine, sp.sin)))
    derivation = solve_for_position(mechanism)
    determinant = derivation.determinants[0] if derivation.determinants else None
    turned = [let for let in heading_at_joints(mechanism) if let not in trigonometric]
    solved = (*_in_assembly_mode(derivation, mechanism), *miss_checks(mechanism))
    known = (*checks, *fixed_lets(mechanism), *trigonometric, *turned, *solved)
    position_values = tuple(real(c) if c in mechanism.task.position else sp.Integer(0) for c in COORDINATE_NAMES)
    rotation = sp.eye(3) if mechanism.heading is None else about_z(cosine(HEADING), sine(HEADING))
    return Forward(known, position_values, tuple(rotation), determinant)


def _frame_by_frame(mechanism: Mechanism, checks: tuple[Statement, ...]) -> Forward:
    """The pose of a spatial chain."""
    composed = named_pose(mechanism)
    names = (*(real(c) for c in COORDINATE_NAMES), *ROTATION_ENTRIES)
    pose = tuple(Let(n, v) for n, v in zip(names, (*composed.position, *composed.rotation), strict=True))
    return Forward((*checks, *composed.statements, *pose), names[:3], names[3:])


@counted
def solve_for_position(mechanism: Mechanism) -> Derivation:
    """The stated closure solved for x, y and z by the same solver, with the joints known."""
    closure = position_closure(mechanism)
    problem = Problem(
        angles=(),
        lengths=tuple(real(c) for c in mechanism.task.position),
        equations=closure.equations,
        units=all_angles(mechanism),
        references={},
        scale=SCALE,
        signs=signs_of(mechanism),
    )
    return solve(problem, (), lambda angle: ())


def _in_assembly_mode(derivation: Derivation, mechanism: Mechanism) -> tuple[Statement, ...]:
    """The derivation in the assembly mode of the machine; its status is IMPOSSIBLE where the loop does not close."""
    sides = {s.sigma: ASSEMBLY_SIGN for s in derivation.determinants}
    chosen = (rewritten(s, lambda e: e.xreplace(sides)) for s in derivation.statements)
    return tuple(replace(s, otherwise=Status.IMPOSSIBLE) if isinstance(s, Require) else s for s in chosen)


def _positive(mechanism: Mechanism) -> tuple[Statement, ...]:
    """The conditions that quantities are positive: forward kinematics refuses the mirror image of the machine."""
    checks: list[Statement] = []
    lengths = {j.symbol for j in mechanism.joints if not j.is_angle}
    bounded = {j.symbol for j in mechanism.joints if j.domain is not None}
    for value in (v for v in mechanism.positive if not v.free_symbols <= bounded):  # a domain already requires it
        scale = SCALE if value.free_symbols & lengths else sp.Integer(1)
        lets, (named,) = named_trigonometry(mechanism, [value])
        condition = sp.Ge(named, -BOUNDARY * scale)
        checks += [*lets, Require(condition, Status.IMPOSSIBLE, reason=about_machine(Why.OTHER_MIRROR))]
    return (*checks, *_domains(mechanism))


def _domains(mechanism: Mechanism) -> tuple[Require, ...]:
    """The conditions that joints are in their domains: beyond, forward and inverse kinematics would not agree."""
    checks: list[Require] = []
    for joint in mechanism.joints:
        if joint.domain is None:
            continue
        low, high = (sp.Integer(int(v)) for v in joint.domain)
        value = joint.axis - joint.offset
        inside = sp.And(sp.Ge(value, low - LIMIT * (1 + abs(low))), sp.Le(value, high + LIMIT * (1 + abs(high))))
        checks.append(Require(inside, Status.IMPOSSIBLE, reason=about(joint.name, Why.NO_POSE)))
    return tuple(checks)


def at_point(forward: Forward) -> Forward:
    """Forward kinematics of a point off the flange: x, y and z are its position."""
    flange = {real(c): real(f"flange_{c}") for c in COORDINATE_NAMES}
    statements: list[Statement] = [rewritten(s, lambda e: e.xreplace(flange)) for s in forward.statements]
    statements = [replace(s, name=flange.get(s.name, s.name)) if isinstance(s, Let) else s for s in statements]
    behind = [sp.sympify(p).xreplace(flange) for p in forward.position]
    arm = sp.Matrix(3, 3, forward.rotation) * sp.Matrix(OFFSET)
    point = tuple(Let(real(c), p + a) for c, p, a in zip(COORDINATE_NAMES, behind, arm, strict=True))
    return replace(forward, statements=(*statements, *point), position=tuple(p.name for p in point))


def forward_program(mechanism: Mechanism, forward: Forward, margins: tuple[Let, ...]) -> Program:
    """Position, rotation, and the signed margin of every branch."""
    outputs = [Output(c, v) for c, v in zip(COORDINATE_NAMES, forward.position, strict=True)]
    outputs += _rotation_outputs(forward)
    outputs += [Output(m.name.name, m.name) for m in margins]
    return normalise("forward", (*forward.statements, *margins), outputs)


def orientation_program(forward: Forward) -> Program:
    """The rotation alone. For a plate that keeps its orientation it is constant, whatever the axis values are."""
    outputs = _rotation_outputs(forward)
    statements = forward.statements
    if not any(o.value.free_symbols for o in outputs):
        statements = tuple(s for s in statements if isinstance(s, Require) and s.otherwise is Status.BAD_INPUT)
    return normalise("orientation", statements, outputs)


def _rotation_outputs(forward: Forward) -> list[Output]:
    return [Output(r.name, v) for r, v in zip(ROTATION_ENTRIES, forward.rotation, strict=True)]


def derivation_at_axes(mechanism: Mechanism, inverse: Inverse, forward: Forward) -> tuple[Statement, ...]:
    """The names of the inverse derivation at given axis values, for the determinants and the conditioning of its steps.

    Sines and cosines that the inverse solves for are those of the given joints; all other names keep their definitions.
    """
    table = _angle_values(mechanism, inverse)
    trigonometric = {f(a): Let(f(a), g(v)) for a, v in table.items() for f, g in ((sine, sp.sin), (cosine, sp.cos))}
    solved = {s for j in mechanism.joints for s in (j.symbol, j.axis, j.motor)}
    own = {s.name for s in forward.statements if isinstance(s, Let)}
    naming = [s for j in inverse.frozen for s in frozen_lets(j)]
    dropped = solved | own | {s.name for s in naming if isinstance(s, Let)} | trigonometric.keys()
    kept = [
        s for s in (*inverse.closure.lets, *inverse.derivation.plain) if isinstance(s, Let) and s.name not in dropped
    ]
    present = {s.name for s in forward.statements if isinstance(s, Let)}
    lets = tuple(s for n, s in trigonometric.items() if n not in present)
    lets += tuple(Let(s.sigma, Select(sp.Ge(s.value, 0), 1, -1)) for s in inverse.derivation.determinants)
    fixed = tuple(let for let in fixed_lets(mechanism) if let.name not in own)
    return (*forward.statements, *fixed, *at_the_pose(mechanism), *lets, *kept)


def _angle_values(mechanism: Mechanism, inverse: Inverse) -> dict[sp.Symbol, sp.Expr]:
    """Every angle that the derivation names, as an expression of the joints."""
    table: dict[sp.Symbol, sp.Expr] = {a: a for a in angles_of(mechanism)}
    for total in inverse.derivation.sums:
        table[total.symbol] = sp.Add(*[table[a] * s for a, s in total.terms])
    if mechanism.chain is not None and mechanism.task.turning is Turning.ABOUT_Z:
        table[HEADING] = heading_of(mechanism.chain)
    elif mechanism.heading is not None:
        table[HEADING] = mechanism.heading
    return table
