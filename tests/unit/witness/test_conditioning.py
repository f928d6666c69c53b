"""Machines that are never well conditioned: the witness accepts their right formulas, and still refuses wrong ones."""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import pytest
from sympy import Float, sin

from derive.description.mechanism import Mechanism, Parameter, Role, Task, branch, distance, length, linear, rotary
from derive.description.validate import validate
from derive.frames import Chain, Ry, Rz, Tx, Ty, Tz
from derive.ir.program import Let, Program
from derive.ir.symbols import is_condition, is_count
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.mechanism import Turning
from derive.witness import Disagreement, witness
from tests.unit.kinematics.inventions import described as invented

pytestmark = pytest.mark.slow

A1, A2, A3, B, C = (rotary(n, "turn") for n in ("A1", "A2", "A3", "B", "C"))
X, Y, Z = (linear(n, "slide") for n in "XYZ")
ELBOW = (branch("elbow", sin(A2), right=+1, left=-1),)
TILT = (branch("tilt", sin(B), positive=+1, negative=-1),)


def links(*sizes: float) -> tuple[Parameter, ...]:
    return tuple(length(f"link_{k}", "link", nominal=size) for k, size in enumerate(sizes, 1))


def described(chain: Chain, **stated: object) -> Mechanism:
    common = {"chain": chain, "offset_interface": False}
    return validate(invented(**{**common, **stated}))


def planar(*sizes: float) -> Mechanism:
    one, two, three = links(*sizes)
    chain = Rz(A1) * Tx(one) * Rz(A2) * Tx(two) * Rz(A3) * Tx(three)
    task = Task("xy", Turning.ABOUT_Z)
    return described(chain, joints=(A1, A2, A3), parameters=(one, two, three), task=task, branches=ELBOW)


def head(*sizes: float) -> Mechanism:
    """A head whose pivots are distances, which may vanish."""
    first, second, third = (distance(f"pivot_{k}", "pivot", nominal=v) for k, v in enumerate(sizes, 1))
    chain = Tx(X) * Ty(Y) * Tz(Z) * Rz(C) * Tx(first) * Ry(B) * Tx(second) * Tz(third)
    task = Task("xyz", Turning.DIRECTION)
    return described(chain, joints=(X, Y, Z, B, C), parameters=(first, second, third), task=task, branches=TILT)


@cache
def short_link() -> Kinematics:
    """One of its links is three thousandths of the others."""
    return build(planar(0.3, 0.001, 0.4))


UNLIKE = {
    "a link of a millimetre, in metres": planar(0.3, 0.001, 0.4),
    "links of ten metres, in millimetres": planar(1e4, 1e4, 10.0),
    "pivots of a millimetre, in metres": head(0.001, 0.001, 0.25),
    "pivots of ten metres": head(1e4, 0.5, 20.0),
}


@pytest.mark.parametrize("kind", UNLIKE)
def test_right_formulas_are_accepted(kind: str) -> None:
    """Whatever the lengths: every machine has poses to measure, and they close to rounding."""
    evidence = witness(build(UNLIKE[kind]), UNLIKE[kind])
    assert evidence.inverted is not None
    assert evidence.inverted.solutions == 2
    assert evidence.closure_residual <= 1e-12


def planted(program: Program) -> Iterator[Program]:
    """The program with one value wrong by a millionth, for every value that a turn is not chosen by."""
    for place, statement in enumerate(program.body):
        if not isinstance(statement, Let) or is_count(statement.name) or is_condition(statement.value):
            continue
        if not statement.name.name.startswith(("reference_", "open_", "near_")):
            wrong = replace(statement, value=statement.value * Float(1.000001))
            yield replace(program, body=(*program.body[:place], wrong, *program.body[place + 1 :]))


def test_a_millionth_is_refused_in_every_value_of_the_inverse() -> None:
    """At poses that are a thousand times worse conditioned than regular ones a wrong formula does not pass."""
    kinematics = short_link()
    changes = list(planted(kinematics.branch))
    assert len(changes) > 20
    for wrong in changes:
        with pytest.raises(Disagreement, match="inverse kinematics: error|the way back|slot . answers"):
            witness(replace(kinematics, branch=wrong), kinematics.mechanism)


@pytest.mark.parametrize("field", ["forward", "jacobian"])
def test_a_millionth_is_refused_in_every_output(field: str) -> None:
    kinematics = short_link()
    program: Program = getattr(kinematics, field)
    for place, output in enumerate(program.outputs):
        if output.name.startswith("branch_") or output.value.is_number:
            continue
        wrong = replace(output, value=output.value * Float(1.000001))
        outputs = (*program.outputs[:place], wrong, *program.outputs[place + 1 :])
        with pytest.raises(Disagreement):
            witness(replace(kinematics, **{field: replace(program, outputs=outputs)}), kinematics.mechanism)


LENGTHS = (Role.LENGTH, Role.DISTANCE)


@pytest.mark.parametrize("unit", [1e-3, 1e3])
@pytest.mark.parametrize("kind", ["planar", "head"])
def test_the_unit_of_length_changes_no_program(kind: str, unit: float) -> None:
    """Programs and exponents of margins are the same in metres, in millimetres and in micrometres."""
    mechanism = planar(300.0, 250.0, 80.0) if kind == "planar" else head(20.0, 30.0, 90.0)
    scaled = tuple(replace(p, nominal=p.nominal * unit) for p in mechanism.parameters)
    usual, other = build(mechanism), build(replace(mechanism, parameters=scaled))
    assert [(m.name, m.exponent) for m in other.margins] == [(m.name, m.exponent) for m in usual.margins]
    assert other.programs == usual.programs
    assert other.setup.body == usual.setup.body
