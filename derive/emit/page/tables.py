"""The tables of a page: axes, parameters, names in the block, margins, measurements, and operations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import astuple

from derive.description.mechanism import Kind, Parameter
from derive.emit.page.names import Spelling, has_block, inputs_of
from derive.emit.python import entries as python
from derive.kinematics.kinematics import Kinematics
from derive.report.cost import Cost, costs_of

Cells = tuple[str, ...]

_MOTION = {
    Kind.LINEAR: "linear",
    Kind.ROTARY: "rotary",
    Kind.HELICAL: "turns; moves another axis by its pitch",
    Kind.GEARED: "turns, through a gear",
    Kind.DRIVING: "turning motor that moves lengths",
}
COST_HEAD = ("Call", "Additions", "Multiplications", "Divisions", "Square roots", "Sines")


def axes(kinematics: Kinematics) -> Iterator[Cells]:
    """Axis, motion, unit, meaning."""
    for joint in kinematics.mechanism.joints:
        yield joint.name, _MOTION[joint.kind], "deg" if joint.in_degrees else "u", joint.meaning


def parameters(kinematics: Kinematics, spelling: Spelling, *, is_own: bool) -> Iterator[Cells]:
    """Name in equations, meaning, role, range, nominal value, unit, name in Python and as input of the block.

    is_own: the dimensions of the machine; else the offsets, limits and settings that every machine has.
    """
    keywords, inputs = python.inputs(kinematics).names, inputs_of(kinematics)
    dimensions = {p.name for p in kinematics.mechanism.parameters}
    for given in (p for p in kinematics.parameters if (p.name in dimensions) == is_own):
        nominal = f"{given.nominal:g}"
        own = (spelling(given.name), given.meaning, given.role.value, _range(given), nominal, given.unit or "–")
        yield (*own, keywords[given.name], inputs[given.name] if has_block(kinematics) else "–")


def _range(given: Parameter) -> str:
    if given.role.value == "flag":
        return "false, true"
    opening = "]" if given.low_open else "["
    low, high = (("−∞" if v <= -1e9 else "∞" if v >= 1e9 else f"{v:g}") for v in (given.low, given.high))
    return f"{opening}{low} .. {high}]".replace(" ", "\u00a0").replace("-", "−")


def numbers(kinematics: Kinematics, spelling: Spelling) -> Iterator[Cells]:
    """The numbers of a chain that have names."""
    for given in kinematics.mechanism.parameters:
        if given.fixed is not None:
            yield spelling(given.name), f"{given.nominal:.12g}", given.meaning


def measured(kinematics: Kinematics) -> Iterator[Cells]:
    """The measurements of the witness: the quantity, the method, the result."""
    found = kinematics.evidence
    if found is None:
        return
    yield (
        "Closure",
        f"forward kinematics at {found.poses} poses; the result and the axes put into the closure equations as the "
        "description states them, in functions that CasADi makes of the description alone",
        f"largest residual {found.closure_residual:.0e} of the machine's length",
    )
    if found.inverted is None:
        return
    inverted = found.inverted
    yield "In a finite field", "forward and inverse kinematics in the closure, without rounding", found.exact.sentence
    yield "Round trip", "inverse after forward, in the same branch", f"largest difference {inverted.round_trip:.0e}"
    yield (
        "Jacobian",
        "against the derivative of the closure by automatic differentiation",
        f"largest difference {inverted.jacobian:.0e}",
    )
    yield (
        "Number of solutions",
        "real roots of the closure, found by Newton's method from many starts, each against the slots of the inverse",
        f"{inverted.solutions} solutions, and each of them is one of these formulas",
    )
    if inverted.missed is not None:
        missed, total = inverted.missed
        yield "Search", "solutions close to poses where branches meet", f"{missed} missed of {total}"


def operations(kinematics: Kinematics) -> Iterator[Cells]:
    """The largest number of operations of each call."""
    costs = costs_of(kinematics)
    rows: list[tuple[str, Cost]] = [("Forward kinematics", costs.forward)]
    slots = 2 ** len(kinematics.branches)
    if kinematics.branches:
        rows.append(("Inverse kinematics, one branch", costs.inverse))
        rows.append((f"Inverse kinematics, all {slots} branches", costs.automatic))
    else:
        rows.append(("Inverse kinematics", costs.inverse))
    more: Sequence[tuple[str, Cost]] = (
        ("In addition: check of an exact frame", costs.exact),
        ("In addition: repair of a frame", costs.repair),
        (f"In addition: {costs.corner}", costs.corners),
    )
    rows += [(what, cost) for what, cost in more if any(cost.counts)]
    for what, cost in rows:
        yield (what, *map(str, astuple(cost)))


def bounds(kinematics: Kinematics) -> Iterator[str]:
    """The loops that these numbers count."""
    for bound in costs_of(kinematics).bounds:
        yield f"{bound.note}: at most {bound.limit} passes, all of which are counted."


def functions(text: str) -> Iterator[Cells]:
    """The functions on a page, with their definitions."""
    meanings = (
        ("√", "square root; of a radicand that is negative by rounding it is 0"),
        ("atan2", "atan2(y, x): the angle of the direction (x, y), from −π to π; atan2(0, 0) = 0"),
        ("wrap", "the value of an angle in ]−π, π]"),
        ("nearestPeriod", "nearestPeriod(v, c): v + 360 k, k whole, in [c − 180, c + 180[ (degrees)"),
        ("nearestOnArc", "nearestOnArc(a, c, h): the angle of the arc c ± h that is nearest to a"),
        ("select", "select(condition, a, b): a where the condition holds, else b"),
        ("RADIAN", "180/π, one radian in degrees"),
        ("DEGREE", "π/180, one degree in radians"),
    )
    tests = {"√": "<msqrt>", "DEGREE": "<mi>DEGREE</mi>", "RADIAN": "<mi>RADIAN</mi>"}
    for name, meaning in meanings:
        if tests.get(name, f"<mi>{name}</mi>") in text:
            yield name, meaning
