"""Equations of a turning loop that describe rods or planes: however an equation is written, it may say that two points
keep their distance, or that a point stays in a plane.

Let p = x + R t be a point of the platform and b one that joints move. |p - b|^2 - L^2, times a constant, has as
coefficients: of x^2 that constant c, of x_i alone -2 c b_i, and of x_1 times the first row of R, 2 c t. What is left at
R = 1, x = 0 is the square of L. In n . p - d the coefficients of x are n, and those of a column of R are n times a
coordinate of t. The rod or plane that is found must have the stated equation: both are compared at random poses.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np
import sympy as sp

from derive.description.amounts import STATED
from derive.description.loops import FREE_TWIST
from derive.description.mechanism import ROTATION, Mechanism, Plane, Rod, Turning, guide, on_plate, ring_rod, rod
from derive.ir.constants import DEGREE
from derive.ir.interpret import evaluate
from derive.ir.symbols import COORDINATE_NAMES, ROTATION_ENTRIES, real
from derive.plate.legs import about_z, by_angles

_POSES, _SAME, _ROUNDING = 16, 1e-9, 1e-12
_OF_LARGEST = 1e-14
"""The share of the largest term of an equation below which another one is rounding."""


def with_stated_rods(mechanism: Mechanism) -> Mechanism:
    """The mechanism, with rods in place of those closure equations that are such, and planes where the loop turns a
    platform. Other equations are divided by the coefficient of their squares.
    """
    taken = {rod.key for rod in mechanism.rods} | {plane.key for plane in mechanism.guides}
    found: list[Rod | Plane] = []
    left: list[sp.Expr] = []
    for number, equation in enumerate(mechanism.closure, 1):
        name = str(number) if not {str(number), f"guide_{number}"} & taken else f"closure_{number}"
        stated = sp.sympify(equation)
        read: Rod | Plane | None = _rod_in_plane(mechanism, name, stated)
        if mechanism.is_platform:
            read = read or _plane_of(mechanism, name, stated) or _rod_at_half_turns(mechanism, name, stated)
        if read is None:
            left.append(stated if mechanism.is_platform else _divided(mechanism, stated))
        else:
            found.append(read)
    rods = tuple(one for one in found if isinstance(one, Rod))
    guides = tuple(one for one in found if isinstance(one, Plane))
    own = replace(mechanism, rods=(*rods, *mechanism.rods), guides=(*guides, *mechanism.guides))
    return replace(own, closure=tuple(left))


def _divided(mechanism: Mechanism, equation: sp.Expr) -> sp.Expr:
    """The equation, divided by the coefficient of its squares where that is made of numbers and parameters."""
    exact = sp.expand(equation.xreplace({number: sp.Rational(number) for number in equation.atoms(sp.Float)}))
    factors = (sp.factor(exact.coeff(c, 2)) for c in _ORIGIN)
    factor = next((f for f in factors if f != 0), sp.Integer(1))
    is_constant = factor.free_symbols <= {p.symbol for p in mechanism.parameters}
    return sp.expand(exact / factor) if factor != 1 and is_constant else equation


def with_free_twist(mechanism: Mechanism) -> Mechanism:
    """The mechanism with `FREE_TWIST` among its guides, if it commands a direction and no leg feels a turn about it."""
    ends = (*[r.plate for r in mechanism.rods], *[g.plate for g in mechanism.guides])
    is_felt = any(v.free_symbols & {*ROTATION[:, :2]} for end in ends for v in end)
    if not mechanism.is_platform or mechanism.task.turning is not Turning.DIRECTION or mechanism.closure or is_felt:
        return mechanism
    return replace(mechanism, guides=(*mechanism.guides, FREE_TWIST))


def with_positive_lengths(mechanism: Mechanism) -> Mechanism:
    """The mechanism with the lengths of its rods among its positive quantities, if joints change them; not a length
    whose sign a branch of the description tells.
    """
    joints = {j.symbol for j in mechanism.joints}
    in_branches = {s for b in mechanism.branches if not b.is_crossing for s in b.indicator.free_symbols}
    read = [(rod.length, rod.length.free_symbols & joints) for rod in mechanism.rods]
    own = [length for length, names in read if names and not names & in_branches and length not in mechanism.positive]
    return replace(mechanism, positive=(*mechanism.positive, *own)) if own else mechanism


def _plane_of(mechanism: Mechanism, name: str, equation: sp.Expr) -> Plane | None:
    """The plane that has this equation; None if there is none."""
    size = 2 if _is_flat(mechanism, equation) else 3
    coordinates = [real(c) for c in COORDINATE_NAMES[:size]]
    entries = sp.Matrix(3, 3, ROTATION_ENTRIES)[:size, :size]
    is_about_z = mechanism.task.turning is Turning.ABOUT_Z
    expanded = sp.expand(equation.xreplace(_about_z() if is_about_z else {}))
    try:
        form = sp.Poly(expanded, *coordinates, *entries)
    except sp.PolynomialError:
        return None
    normal = sp.Matrix([form.coeff_monomial(c) for c in coordinates])
    if form.total_degree() != 1 or not any(normal) or normal.free_symbols & {j.symbol for j in mechanism.joints}:
        return None
    if is_about_z:
        square = normal[0] ** 2 + normal[1] ** 2
        first, second = (form.coeff_monomial(e) for e in (entries[0, 0], entries[1, 0]))
        flat = [normal[0] * first + normal[1] * second, normal[1] * first - normal[0] * second]
        point = [sp.simplify(v / square) if square != 0 else sp.Integer(0) for v in flat] + [sp.Integer(0)] * (size - 2)
    else:
        square = normal.dot(normal)
        columns = (entries[:, k] for k in range(size))
        ahead = (sum(n * form.coeff_monomial(e) for n, e in zip(normal, column, strict=True)) for column in columns)
        point = [sp.simplify(v / square) for v in ahead]
    read = guide(name, list(normal), on_plate(*point), -form.coeff_monomial(1))
    return read if _is_same(mechanism, read.equation, equation) else None


def _is_flat(mechanism: Mechanism, equation: sp.Expr) -> bool:
    """Whether an equation holds in a plane: no z occurs in it."""
    return mechanism.task.turning in (Turning.ABOUT_Z, Turning.NONE) and real("z") not in equation.free_symbols


def _rod_at_half_turns(mechanism: Mechanism, name: str, equation: sp.Expr) -> Rod | None:
    """The rod, which may end on a ring, that has this equation but for a constant factor, in whatever frame this is
    written; None if there is none.

    Of a centre c = x + R t, an axis n and v = c - b, a rod on a ring has v . v - 2 r d = L^2 - r^2, where d is the root
    of v . v - (v . n)^2. Without it the coefficient of x is R t - b, twice: half turns tell t and b apart.
    """
    if _is_flat(mechanism, equation):
        return None
    exact = {number: sp.Rational(number) for number in equation.atoms(sp.Float)}
    seen = [_at(equation.xreplace(exact), turns) for turns in ((1, 1, 1), (-1, -1, 1), (1, -1, -1))]
    if any(s is None for s in seen):
        return None
    factors, twices, forms = zip(*(s for s in seen if s is not None), strict=True)
    level, about_z, about_x = ([form.coeff_monomial(c) / (2 * factors[0]) for c in _ORIGIN] for form in forms)
    point = [(level[0] - about_z[0]) / 2, (level[1] - about_z[1]) / 2, (level[2] - about_x[2]) / 2]
    base = [sp.expand(p - v) for p, v in zip(point, level, strict=True)]
    radius = sp.cancel(-twices[0] / (2 * factors[0]))
    square = sp.expand(sum(v**2 for v in level) + radius**2) - sp.expand(forms[0].coeff_monomial(1) / factors[0])
    length = _root_of(mechanism, square)
    if length is None:
        return None
    ends = [_plain(sp.expand(v)) for v in base], on_plate(*(_plain(sp.expand(v)) for v in point))
    read = rod(name, *ends, _plain(length)) if radius == 0 else ring_rod(name, *ends, _plain(radius), _plain(length))
    return read if _is_same(mechanism, read.equation * factors[0], equation) else None


def _at(equation: sp.Expr, turns: Sequence[int]) -> tuple[sp.Expr, sp.Expr, sp.Poly] | None:
    """The equation at half turns of the platform: the factor of x^2, that of a root in it, and what is left without."""
    there = sp.expand(equation.xreplace(dict(zip(ROTATION_ENTRIES, sp.diag(*turns), strict=True))))
    roots = {p for p in there.atoms(sp.Pow) if p.exp == sp.Rational(1, 2) and p.free_symbols & {*_ORIGIN}}
    names = dict(zip(roots, [_ROOT], strict=False))
    left = there.xreplace(names)
    if len(roots) > 1 or not left.is_polynomial(_ROOT, *_ORIGIN):
        return None
    twice = sp.expand(left.coeff(_ROOT))
    form = sp.Poly(left - twice * _ROOT, *_ORIGIN)
    factor = form.coeff_monomial(_ORIGIN[0] ** 2)
    if factor == 0 or form.total_degree() != 2 or twice.free_symbols & {*_ORIGIN, _ROOT} or _ROOT in form.free_symbols:
        return None
    return factor, twice, form


def _rod_in_plane(mechanism: Mechanism, name: str, equation: sp.Expr) -> Rod | None:
    """The same as `_rod_of`; where the point moves in a plane its coordinates are read as x and y."""
    own = [real(c) for c in mechanism.task.position]
    if mechanism.is_turning_loop or len(own) != 2:
        return _rod_of(mechanism, name, equation)
    read = _rod_of(mechanism, name, equation.xreplace(dict(zip(own, _ORIGIN, strict=False))))
    back = dict(zip(_ORIGIN, own, strict=False))
    return None if read is None else replace(read, plate=tuple(v.xreplace(back) for v in read.plate))


def _rod_of(mechanism: Mechanism, name: str, equation: sp.Expr) -> Rod | None:
    """The rod that has this equation but for a constant factor; None if there is none."""
    size = 2 if _is_flat(mechanism, equation) else 3
    coordinates = [real(c) for c in COORDINATE_NAMES[:size]]
    names = [real(f"r{i + 1}{j + 1}") for i in range(size) for j in range(size)]
    is_about_z = mechanism.task.turning is Turning.ABOUT_Z
    exact = {number: sp.Rational(number) for number in equation.atoms(sp.Float)}
    expanded = sp.expand(equation.xreplace(exact | (_about_z() if is_about_z else {})))
    try:
        form = sp.Poly(expanded, *coordinates, *names)
    except sp.PolynomialError:
        return None
    factor = form.coeff_monomial(coordinates[0] ** 2)
    if factor == 0 or factor.free_symbols & {j.symbol for j in mechanism.joints}:
        return None
    base = [sp.cancel(-form.coeff_monomial(c) / (2 * factor)) for c in coordinates]
    arm = _arm(form, coordinates, size, is_about_z=is_about_z)
    plate = on_plate(*(a / (2 * factor) for a in arm))
    at_rest = dict(zip(ROTATION_ENTRIES, sp.eye(3), strict=True)) | {c: sp.Integer(0) for c in coordinates}
    between = sp.Add(*[(p - b) ** 2 for p, b in zip(plate, base, strict=True)])
    square = _without_rounding(mechanism, between.xreplace(at_rest), (expanded / factor).xreplace(at_rest))
    length = _root_of(mechanism, square)
    if length is None or not (mechanism.is_platform or _has_a_sign(mechanism, length)):
        return None
    read = rod(name, [_plain(v) for v in base], [_plain(v) for v in plate], _plain(length))
    return read if _is_same(mechanism, read.equation, equation / factor) else None


def _has_a_sign(mechanism: Mechanism, length: sp.Expr) -> bool:
    """Whether no joint can turn round the sign of a length: a square alone would allow both."""
    return length in mechanism.positive or not length.free_symbols & {j.symbol for j in mechanism.joints}


def _root_of(mechanism: Mechanism, square: sp.Expr) -> sp.Expr | None:
    """The length with this square; None where joints are left in a root."""
    if square.is_Rational and square.q > STATED and square > 0 and not sp.sqrt(square).is_Rational:
        return sp.Rational(math.sqrt(square))  # the root of decimals that were multiplied
    length = sp.powdenest(sp.sqrt(sp.factor(square)), force=True).replace(sp.Abs, lambda of: of)
    joints = {j.symbol for j in mechanism.joints}
    if length.has(sp.I) or any(p.exp == sp.Rational(1, 2) and p.free_symbols & joints for p in length.atoms(sp.Pow)):
        return None
    nominal = {p.symbol: sp.Float(p.nominal) for p in mechanism.parameters}
    nominal |= {j.symbol: sp.Float(j.nominal) for j in mechanism.joints}
    return -length if length.xreplace(nominal).is_negative else length  # a square tells no sign, and a length has one


def _without_rounding(mechanism: Mechanism, one: sp.Expr, other: sp.Expr) -> sp.Expr:
    """The difference, without terms that are only rounding."""
    fixed = {p.symbol: sp.Float(p.nominal) for p in mechanism.parameters if p.fixed is not None} | {DEGREE: sp.pi / 180}
    numbers: dict[sp.Expr, list[sp.Expr]] = {}
    for term in (*sp.Add.make_args(sp.expand(one)), *sp.Add.make_args(sp.expand(-other))):
        number, product = term.as_independent(*(term.free_symbols - {*fixed}), as_Add=False)
        numbers.setdefault(product, []).append(number)
    values = {product: [float(n.xreplace(fixed)) for n in some] for product, some in numbers.items()}
    sizes = {product: sum(map(abs, some)) for product, some in values.items()}
    least = _OF_LARGEST * max(sizes.values())
    kept = (p for p in numbers if abs(sum(values[p])) > max(_ROUNDING * sizes[p], least))
    return sp.Add(*[p * n for p in kept for n in numbers[p]])


def _plain(value: sp.Expr) -> sp.Expr:
    """The value with long fractions as the decimals that they are but for rounding, else as floating-point numbers."""
    decimals = {r: sp.Rational(f"{float(r):.15g}") for r in value.atoms(sp.Rational) if r.q > STATED}
    return value.xreplace({r: short if short.q <= STATED else sp.Float(r) for r, short in decimals.items()})


def _about_z() -> dict[sp.Symbol, sp.Expr]:
    """The entries of a rotation about z, expressed by two of them."""
    return dict(zip(ROTATION_ENTRIES, about_z(real("r11"), real("r21")), strict=True))


def _arm(form: sp.Poly, coordinates: Sequence[sp.Symbol], size: int, *, is_about_z: bool) -> list[sp.Expr]:
    """The point of the platform, times twice the constant factor of the equation."""
    first, second = coordinates[:2]
    if not is_about_z:
        return [form.coeff_monomial(first * real(f"r1{j + 1}")) for j in range(size)]
    flat = [form.coeff_monomial(c * real("r11")) for c in (first, second)]
    return flat if size == 2 else [*flat, sp.Integer(0)]  # its height may equally belong to the base point


def _is_same(mechanism: Mechanism, one: sp.Expr, other: sp.Expr) -> bool:
    """Whether two equations agree at random poses, joints and parameters, as far as rounding allows."""
    rng = np.random.default_rng(7)
    words = [f"{f}_{a}" for a in ("roll", "pitch", "yaw") for f in ("cos", "sin")]
    angles = dict.fromkeys(("roll", "pitch", "yaw"), np.zeros(_POSES))
    turning = angles if mechanism.task.turning is not Turning.ABOUT_Z else ("yaw",)
    angles |= {a: rng.uniform(-3.0, 3.0, _POSES) for a in turning}
    turned = {w: (np.cos if w[:3] == "cos" else np.sin)(angles[w[4:]]) for w in words}
    values = {n.name: evaluate(v, turned) for n, v in zip(ROTATION_ENTRIES, by_angles(), strict=True)}
    values |= {p.symbol.name: np.asarray(p.nominal) for p in mechanism.parameters if p.fixed is not None}
    values[DEGREE.name] = np.asarray(np.pi / 180.0)
    for symbol in sorted(one.free_symbols | other.free_symbols, key=str):
        values.setdefault(symbol.name, rng.uniform(0.5, 2.0, _POSES))
    first, second = (np.broadcast_to(evaluate(e, values), (_POSES,)) for e in (one, other))
    return bool(np.all(np.abs(first - second) <= _SAME * (1.0 + np.abs(second))))


End = TypeVar("End", Rod, Plane)
_ORIGIN = tuple(real(c) for c in COORDINATE_NAMES)
_ROOT = sp.Symbol("root of a ring")


def with_fixed_point(mechanism: Mechanism) -> Mechanism:
    """The mechanism with the planes that hold its point at the origin, its bearing, if its equations only turn it.

    Two directions that enclose a fixed angle, w of a joint and R v of the platform, are the ends of a rod: w . R v = c
    says that |w - R v|^2 = |w|^2 + |v|^2 - 2 c.
    """
    read = {s for e in mechanism.equations for s in e.free_symbols}
    if not mechanism.is_platform or mechanism.task.position or read & {*_ORIGIN}:
        return mechanism
    taken = {r.key for r in mechanism.rods} | {p.name for p in mechanism.guides}
    ends = [_leg(mechanism, k, e, taken) for k, e in enumerate(mechanism.closure, 1)]
    legs = [end for end in ends if end is not None]
    planes = tuple(
        guide(f"centre_{c}", tuple(int(c == d) for d in COORDINATE_NAMES), on_plate(0, 0, 0)) for c in COORDINATE_NAMES
    )
    home = (*[sp.Integer(0)] * 3, *mechanism.home) if mechanism.home else ()
    return replace(
        mechanism,
        closure=tuple(e for e, end in zip(mechanism.closure, ends, strict=True) if end is None),
        rods=(*legs, *(_held(r) for r in mechanism.rods)),
        guides=(*planes, *(_held(g) for g in mechanism.guides)),
        home=home,
    )


def _held(leg: End) -> End:
    """A copy of the leg in which its point of the platform has its coordinates from the origin."""
    if len(leg.plate) != len(_ORIGIN):
        return leg
    return replace(leg, plate=tuple(p + c for p, c in zip(leg.plate, _ORIGIN, strict=True)))


def _leg(mechanism: Mechanism, number: int, equation: sp.Expr, taken: set[str]) -> Rod | None:
    """The rod between two directions, where the equation says that they enclose a fixed angle; else None."""
    try:
        form = sp.Poly(sp.expand(equation), *ROTATION_ENTRIES)
    except sp.PolynomialError:
        return None
    if form.total_degree() != 1:
        return None
    product = sp.Matrix(3, 3, [form.coeff_monomial(r) for r in ROTATION_ENTRIES])
    column = next(k for k in range(3) if any(v != 0 for v in product[:, k]))
    first = product[:, column]
    row = next(k for k in range(3) if first[k] != 0)
    own = [sp.simplify(product[row, k] / first[row]) for k in range(3)]
    joints = {j.symbol for j in mechanism.joints}
    size, rest = sp.simplify(first.dot(first)), form.coeff_monomial(1)
    is_product = all(sp.simplify(v) == 0 for v in product - first * sp.Matrix([own]))
    moved = {s for v in (*own, size, rest) for s in sp.sympify(v).free_symbols} & joints
    if not is_product or moved:
        return None
    length = sp.sqrt(sp.factor(sp.simplify(size + sum(v**2 for v in own) + 2 * rest)))
    name = str(number) if str(number) not in taken else f"closure_{number}"
    return rod(name, list(first), on_plate(*own), length)
