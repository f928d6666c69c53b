"""The Jacobian on a page: the matrices A and B of the closure, the program, and the determinant with its factors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import sympy as sp
from markupsafe import Markup

from derive.description.mechanism import Mechanism
from derive.emit.page.lines import Line, Lines, matrix
from derive.emit.page.mathml import element, operator, word
from derive.emit.page.steps import Stated
from derive.equations.closures.fixed_names import with_fixed_names
from derive.equations.trigonometry import named_trigonometry
from derive.ir.program import Output
from derive.ir.symbols import HEADING, cosine, real, sine
from derive.kinematics.kinematics import Kinematics, Margin
from derive.lowering.passes import structured
from derive.report.derived import Derived


@dataclass(frozen=True)
class Matrices:
    """A = dΦ/dx and B = dΦ/dq of stated equations, entry by entry; of others only what they are, in words."""

    words: str
    entries: tuple[Stated, ...] = ()


def matrices_of(derived: Derived, lines: Lines) -> Matrices:
    """The matrices of A x' + B q' = 0."""
    mechanism = derived.mechanism
    if mechanism.chain is not None:
        return Matrices(
            "The closure of a chain is f(q) − x = 0: A is the negative identity, and B, its derivative by the joints, "
            "is the Jacobian itself. A column is the screw of a joint: the direction of its axis, and the cross "
            "product of that with the way from the axis to the tool."
        )
    if mechanism.is_platform:
        return Matrices(
            "A row of A is the line of a leg: its unit vector, and its moment about the origin of the platform. B "
            "holds how fast each axis moves its legs along themselves. The rows are the linear equations below."
        )
    return Matrices(
        "A holds the derivatives of the closure equations by the commanded coordinates, B those by the joints; "
        "entries that are not listed are zero. The Jacobian is −A⁻¹ B.",
        tuple(_entries(mechanism, lines)),
    )


def _entries(mechanism: Mechanism, lines: Lines) -> Iterator[Stated]:
    closure = sp.Matrix([with_fixed_names(mechanism, e) for e in mechanism.equations])
    heading = sp.Integer(0) if mechanism.heading is None else mechanism.heading
    turned = closure.xreplace({cosine(HEADING): sp.cos(heading), sine(HEADING): sp.sin(heading)})
    joints = [(j.symbol, j.name) for j in mechanism.joints]
    coordinates = [(real(c), c) for c in mechanism.task.position]
    for letter, equations, unknowns in (("A", closure, coordinates), ("B", turned, joints)):
        values = list(equations.jacobian([symbol for symbol, _ in unknowns]))
        _, named = named_trigonometry(mechanism, values)
        for place, value in enumerate(named):
            if value != 0:
                row, column = divmod(place, len(unknowns))
                label = f"{letter}: equation {row + 1} by {unknowns[column][1]}"
                yield Stated(label, lines.math.lines(sp.factor_terms(value)))


@dataclass(frozen=True)
class Entries:
    """The outputs of the program: as a matrix, and those that are neither names nor numbers."""

    matrix: Markup
    lines: tuple[Line, ...]


def jacobian_of(kinematics: Kinematics, lines: Lines) -> tuple[tuple[Line, ...], Entries]:
    """The program of the Jacobian."""
    body = tuple(lines.of(structured(kinematics.jacobian)))
    outputs = kinematics.jacobian.outputs
    width = len(kinematics.mechanism.joints)
    rows = [[_cell(o, lines) for o in outputs[k : k + width]] for k in range(0, len(outputs), width or 1)]
    named_lines = tuple(
        Line("value", element((word(_name(o)),)), lines.math.lines(o.value), neutral=o.name)
        for o in outputs
        if not _is_short(o.value)
    )
    return body, Entries(matrix(rows), named_lines)


def _cell(output: Output, lines: Lines) -> str:
    return element(lines.math.row(output.value)) if _is_short(output.value) else element((word(_name(output)),))


def _name(output: Output) -> str:
    return f"J{output.name.removeprefix('j')}"


def _is_short(value: sp.Expr) -> bool:
    return bool(value.is_number or value.is_Symbol or (-value).is_Symbol)


def factored(margins: Sequence[Margin]) -> Markup:
    """√det(J Jᵀ) = constant · the margins with their exponents."""
    above = [_power(m.factor, m.exponent) for m in margins if m.exponent > 0]
    below = [_power(m.factor, -m.exponent) for m in margins if m.exponent < 0]
    times = operator("⋅").text
    top = times.join(["<mi>k</mi>", *above]) if above or not below else "<mi>k</mi>"
    right = f"<mfrac><mrow>{top}</mrow><mrow>{times.join(below)}</mrow></mfrac>" if below else top
    left = "<msqrt><mrow><mi>det</mi><mo>(</mo><mi>J</mi><msup><mi>J</mi><mi>T</mi></msup><mo>)</mo></mrow></msqrt>"
    return Markup(f'<math displaystyle="true"><mrow>{left}<mo>=</mo>{right}</mrow></math>')


def _power(name: str, exponent: int) -> str:
    inside = f"<mrow><mo>|</mo><mi>{name}</mi><mo>|</mo></mrow>"
    return inside if exponent == 1 else f"<msup>{inside}<mn>{exponent}</mn></msup>"
