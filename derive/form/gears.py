"""Gears that stand in a chain: `Rz(A1/3)`, `Ry((A + B)/2) * Rx((A - B)/2)`, `Tx((A + B)/20)`.

In the chain of the mechanism that is returned every angle is a sum of joints, each with a sign. The joints turn
independently of each other: a whole turn of one leaves the pose as it is. A joint is `ratio` times its own motor, plus
its coupling to motors of earlier axes. So the turns of an axis are those of its joint: behind a gear that takes three
turns down to one the axis repeats after 1080 degrees. On a differential A repeats after 360 degrees, where B follows by
360 degrees in one sense or the other; while A does not move, B repeats after 720 degrees.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from fractions import Fraction
from math import lcm

import sympy as sp

from derive.description.dimensions import Role
from derive.description.mechanism import Bound, DescriptionError, Joint, Kind, Limited, Mechanism, Rod
from derive.geometry.frames import Chain, Motion

Table = dict[sp.Symbol, sp.Expr]
_LARGEST_DENOMINATOR, _SAME = 10**5, 1e-14
"""A gear written as a decimal number is taken as a fraction with at most this denominator, if it is this near."""
_NUMBERS_ALONE = "state every angle by motors of earlier axes and its own, or give the gears as numbers"


def with_gears(mechanism: Mechanism) -> Mechanism:
    """The mechanism with its gears at the joints, where the chain turns by more or less than its joints.

    Raises `DescriptionError` if an angle is no whole multiple of what the others turn by, or a gear may be zero.
    """
    symbols = tuple(j.symbol for j in mechanism.joints)
    arguments = _arguments(mechanism)
    forms = tuple(dict.fromkeys(f for a in arguments if (f := _form(a, symbols)) is not None))
    angles = tuple(s for s in symbols if any(f.has(s) for f in forms))
    if forms and not _is_plain(mechanism, forms, angles):
        rows = [[f.coeff(a) for a in angles] for f in forms]
        basis = _triangular(_basis(rows, len(angles)))
        mechanism = _replaced(mechanism, angles, sp.Matrix(basis))
    return _checked(_with_driving(mechanism))


def _with_driving(mechanism: Mechanism) -> Mechanism:
    """The mechanism, in which a turning motor that moves lengths alone is such a one."""
    turned = {s for argument in _arguments(mechanism) for s in argument.free_symbols}
    turning = [j for j in mechanism.joints if j.kind in (Kind.ROTARY, Kind.GEARED) and not j.loops]
    driving = {j.symbol for j in turning if j.symbol not in turned}
    joints = tuple(
        replace(j, kind=Kind.DRIVING, multi_turn=False) if j.symbol in driving else j for j in mechanism.joints
    )
    return replace(mechanism, joints=joints, periods=_periods(mechanism, driving)) if driving else mechanism


def _periods(mechanism: Mechanism, driving: set[sp.Symbol]) -> tuple[str, ...] | None:
    """The axes with periods: a motor that moves lengths alone has none."""
    if mechanism.periods is None:
        return None
    gone = {j.name for j in mechanism.joints if j.symbol in driving}
    return tuple(name for name in mechanism.periods if name not in gone)


def _arguments(mechanism: Mechanism) -> tuple[sp.Expr, ...]:
    """The angles by which the closure turns."""
    if mechanism.chain is not None:
        return tuple(f.amount for f in mechanism.chain.factors if f.motion is Motion.TURN)
    functions = {f for e in mechanism.equations for f in sp.sympify(e).atoms(sp.sin, sp.cos)}
    heading = () if mechanism.heading is None else (mechanism.heading,)
    return (*(f.args[0] for f in sorted(functions, key=sp.default_sort_key)), *heading)


def _form(argument: sp.Expr, symbols: Sequence[sp.Symbol]) -> sp.Expr | None:
    """The joints in an angle, as a linear form; None if it has none, or is not linear."""
    expanded = sp.expand(argument)
    own = sp.Add(*[expanded.coeff(s) * s for s in symbols])
    is_linear = not (expanded - own).free_symbols & set(symbols)
    return _exact(own) if own != 0 and is_linear else None


def _exact(argument: sp.Expr) -> sp.Expr:
    """An angle in which the decimal numbers that multiply are fractions: 0.3333333333333333 is a third."""
    floats = {n for n in argument.atoms(sp.Float) if n != argument}
    return sp.expand(argument.xreplace({n: _fraction(float(n)) for n in floats}))


def _fraction(number: float) -> sp.Rational:
    near = Fraction(number).limit_denominator(_LARGEST_DENOMINATOR)
    exact = near if abs(float(near) - number) <= _SAME * abs(number) else Fraction(repr(number))
    return sp.Rational(exact.numerator, exact.denominator)


def _is_plain(mechanism: Mechanism, forms: Sequence[sp.Expr], angles: Sequence[sp.Symbol]) -> bool:
    """Whether every angle is a sum of joints with signs, and only whole turns of the joints leave them unchanged."""
    signs = {p.symbol: p for p in mechanism.parameters if p.role in (Role.SIGN, Role.FLAG)}
    rows = []
    for form in forms:
        row = [form.coeff(a) for a in angles]
        if any(c not in (0, 1, -1) and (c.is_number or not c.free_symbols <= signs.keys()) for c in row):
            return False
        rows.append([c if c in (0, 1, -1) else sp.Integer(1) for c in row])
    matrix = sp.Matrix(rows)
    if matrix.rank() < len(angles):
        return True  # fewer angles than joints: this is refused elsewhere
    return bool(abs(sp.Matrix(_triangular(_lattice(matrix.tolist()))).det()) == 1)


def _basis(rows: list[list[sp.Expr]], count: int) -> list[list[sp.Expr]]:
    """A basis of the angles, by rows: as many as joints, and all other angles are sums of these with signs."""
    if all(c.is_Rational for row in rows for c in row):
        return _lattice(rows)
    chosen: list[list[sp.Expr]] = []
    for row in rows:
        if sp.Matrix([*chosen, row]).rank(simplify=True) == len(chosen) + 1:
            chosen.append(row)
    basis = sp.Matrix(chosen)
    if len(chosen) == count:
        for row in rows:
            shares = (sp.Matrix([row]) * basis.inv()).applyfunc(sp.simplify)
            if not all(share.is_Integer for share in shares):
                turned = ", ".join(str(c) for c in row)
                raise DescriptionError(
                    f"the chain turns by ({turned}) of its motors, which is no sum of its other turns; {_NUMBERS_ALONE}"
                )
    return chosen


def _lattice(rows: list[list[sp.Expr]]) -> list[list[sp.Expr]]:
    """A basis of all sums of whole multiples of rows of numbers: row echelon from the right, without rows of zeros."""
    size = lcm(*(int(sp.Rational(c).q) for row in rows for c in row))
    left = [[int(c * size) for c in row] for row in rows]
    found: list[list[int]] = []
    for column in reversed(range(len(rows[0]))):
        while len([row for row in left if row[column]]) > 1:
            left.sort(key=lambda row: (row[column] == 0, abs(row[column])))
            least = left[0]
            left[1:] = [
                [a - (row[column] // least[column]) * b for a, b in zip(row, least, strict=True)] for row in left[1:]
            ]
        pivots = [row for row in left if row[column]]
        left = [row for row in left if not row[column]]
        found = [*pivots, *found]
    return [[sp.Rational(c, size) for c in row] for row in found]


def _triangular(basis: list[list[sp.Expr]]) -> list[list[sp.Expr]]:
    """The rows in an order in which row k ends at motor k. Raises `DescriptionError` if there is no such order."""
    count = len(basis[0])
    ends = [max(k for k, c in enumerate(row) if c != 0) for row in basis]
    if len({*ends}) == len(basis):  # motors that share a turn, but only shift by themselves
        others = [k for k in range(count) if k not in ends]
        basis = [*basis, *([sp.Integer(k == j) for j in range(count)] for k in others)]
        ends = [*ends, *others]
    if sorted(ends) != list(range(count)):
        raise DescriptionError(
            f"{len(basis)} turns of the chain share {count} motors so that none follows from the ones before it; "
            + _NUMBERS_ALONE
        )
    return [basis[ends.index(k)] for k in range(count)]


def _replaced(mechanism: Mechanism, angles: Sequence[sp.Symbol], basis: sp.Matrix) -> Mechanism:
    """The mechanism in the angles of a basis, which keep the names of its joints."""
    own = sp.Matrix([j for a in angles for j in [a]])
    inverse = basis.inv().applyfunc(sp.simplify)
    table: Table = dict(zip(angles, list(inverse * own), strict=True))
    by_symbol = {j.symbol: j for j in mechanism.joints}
    motors = {a: by_symbol[a].motor * by_symbol[a].ratio + by_symbol[a].coupling for a in angles}
    whole = [all(c.is_Integer for c in basis[:, k]) for k in range(len(angles))]
    geared = {}
    for k, angle in enumerate(angles):
        joint = by_symbol[angle]
        value = sp.expand(sp.Add(*[basis[k, i] * motors[a] for i, a in enumerate(angles)]))
        ratio = value.coeff(joint.motor)
        kind = joint.kind if joint.kind is not Kind.ROTARY or whole[k] else Kind.GEARED
        geared[angle] = replace(joint, ratio=ratio, coupling=sp.expand(value - ratio * joint.motor), kind=kind)
    joints = tuple(geared.get(j.symbol, j) for j in mechanism.joints)
    return in_other_joints(replace(mechanism, joints=joints), table)


def in_other_joints(mechanism: Mechanism, table: Table) -> Mechanism:
    """Every expression of a mechanism with its joints replaced."""

    def of(value: sp.Basic) -> sp.Expr:
        found = sp.sympify(value).xreplace(table)
        angles = {f: f.func(_exact(f.args[0])) for f in found.atoms(sp.sin, sp.cos)}
        return sp.sympify(found.xreplace(angles))

    def all_of(values: Iterable[sp.Expr]) -> tuple[sp.Expr, ...]:
        return tuple(map(of, values))

    def rods(found: Iterable[Rod]) -> tuple[Rod, ...]:
        return tuple(replace(r, base=all_of(r.base), plate=all_of(r.plate), length=of(r.length)) for r in found)

    def chained(chain: Chain | None) -> Chain | None:
        if chain is None:
            return None
        moved = (_exact(of(f.amount)) if f.motion is Motion.TURN else sp.expand(of(f.amount)) for f in chain.factors)
        return Chain(tuple(replace(f, amount=a) for f, a in zip(chain.factors, moved, strict=True)))

    assembly, search = mechanism.assembly, mechanism.search
    return replace(
        mechanism,
        chain=chained(mechanism.chain),
        drawn=chained(mechanism.drawn),
        closure=all_of(mechanism.closure),
        heading=None if mechanism.heading is None else of(mechanism.heading),
        rods=rods(mechanism.rods),
        bars=rods(mechanism.bars),
        assembly=None if assembly is None else replace(assembly, indicator=of(assembly.indicator)),
        bounds=tuple(Bound(of(b.value), b.largest, b.meaning) for b in mechanism.bounds),
        branches=tuple(b if b.is_crossing else replace(b, indicator=of(b.indicator)) for b in mechanism.branches),
        positive=all_of(mechanism.positive),
        limited=tuple(Limited(q.name, of(q.value), q.is_angle, q.meaning) for q in mechanism.limited),
        search=None if search is None else replace(search, joint=_same(search.joint, mechanism)),
        held=tuple(_same(j, mechanism) for j in mechanism.held),
        surplus=tuple(_same(j, mechanism) for j in mechanism.surplus),
    )


def _same(joint: Joint, mechanism: Mechanism) -> Joint:
    return next((j for j in mechanism.joints if j.name == joint.name), joint)


def _checked(mechanism: Mechanism) -> Mechanism:
    """The mechanism, checked: its gears are never zero."""
    turns = () if mechanism.chain is None else _arguments(mechanism)
    turned = {s for turn in turns for s in turn.free_symbols}
    for joint in mechanism.joints:
        if joint.kind is Kind.LINEAR and not joint.loops and joint.symbol in turned:
            raise DescriptionError(
                f"the chain turns by {joint.name!r}, which is a length: declare it rotary, and let it move lengths, too"
            )
        if joint.loops and (joint.ratio != 1 or joint.coupling != 0):
            raise DescriptionError(f"joint {joint.moved_name!r} is driven by a loop: state its gear in the loop")
        if joint.ratio == 1:
            continue
        if not joint.ratio.is_nonzero:
            raise DescriptionError(
                f"the gear of joint {joint.name!r} is {joint.ratio}, which may be zero: state it by numbers, "
                "lengths and `transmission(...)` alone"
            )
        if joint.domain is not None:
            raise DescriptionError(
                f"joint {joint.name!r} has a gear and a domain: state the domain as limits of its axis"
            )
    return mechanism
