"""All branches in one straight line: the same answers as the branches one by one, and every statement as often as
needed."""

from functools import cache

import numpy as np
import pytest
import sympy as sp

from derive.description.catalogue import MECHANISMS, load
from derive.ir.interpret import run
from derive.ir.passes import normalise, renamed
from derive.ir.primitives import Root
from derive.ir.program import Iterate, Let, Output, Program, Require, Solve, Status, rewritten
from derive.ir.symbols import REFUSAL, Sign, called, choices, count, real, suffixed
from derive.ir.verify import BrokenProgram, verify
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.lost_digits.doubts import without_meeting
from derive.lowering.unrolling import is_straight, unroll
from tests.mechanisms import kinematics_of
from tests.unit.answers import values

pytestmark = pytest.mark.slow

A, B, C, X, Y = (real(n) for n in "abcxy")
ELBOW, WRIST = Sign(real("sigma_elbow"), ("right", "left")), Sign(real("sigma_wrist"), ("down", "up"))
SHAPES = ["kin_scara4_zccoupled_type1", "kin_polar", "kin_gantry2", "kin_tripod_rotary", "kin_articulatedrobot_6dof"]
"""One sign; a sign that some machines have not; none; three that do not depend on each other; three that do."""


def program(*body: Let | Require | Solve | Iterate, outputs: dict[str, sp.Expr]) -> Program:
    names = {name for s in body if isinstance(s, Let) for name in (s.name,)}
    free = {s for e in (*(s.value for s in body if isinstance(s, Let)), *outputs.values()) for s in e.free_symbols}
    free |= {s for r in body if isinstance(r, Require) for s in r.condition.free_symbols}
    inputs = tuple(sorted((s for s in free - names if isinstance(s, sp.Symbol)), key=lambda s: s.name))
    return Program("p", inputs, body, tuple(Output(n, v) for n, v in outputs.items()))


def test_a_negative_is_not_computed_again() -> None:
    found = unroll(program(Let(A, Root(X) * ELBOW.symbol), outputs={"o": A + 1}), (ELBOW,))
    assert values(found) == {"a_right": Root(X)}
    assert {o.name: o.value for o in found.outputs}["o_left"] == 1 - real("a_right")


def test_a_condition_reads_what_stands_for_a_name() -> None:
    """Nothing is bound to a negative of a name: who read it reads that, a condition too."""
    body = (Let(A, -X), Require(sp.Gt(A, -1), Status.UNREACHABLE), Let(B, A + ELBOW.symbol))
    found = unroll(program(*body, outputs={"o": B}), (ELBOW,))
    assert [r.condition for r in found.requires()] == [sp.Gt(-X, -1)]
    assert found.inputs == (X,)


def test_the_refusal_of_a_slot_is_its_first_condition_that_does_not_hold() -> None:
    """Also where a later condition has no sign: it may not refuse before an earlier one with another status."""
    body = (
        Require(sp.Gt(X * ELBOW.symbol, 0), Status.IMPOSSIBLE),
        Require(sp.Gt(Y, 0), Status.UNREACHABLE),
        Require(sp.Gt(Y + X * WRIST.symbol, 1), Status.IMPOSSIBLE),
    )
    looped = program(*body, outputs={"o": X})
    grid = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-2, 2, 9))
    check_equal(
        looped, unroll(looped, (ELBOW, WRIST)), (ELBOW, WRIST), dict(zip("xy", map(np.ravel, grid), strict=True))
    )


def test_linear_equations_are_unrolled_too() -> None:
    system = Solve((A,), (X + ELBOW.symbol,), (Y,), determinant=B)
    looped = Program("p", (ELBOW.symbol, X, Y), (system,), (Output("o", A), Output("d", B)))
    values = {"x": np.array([3.0, 1.0, -1.0]), "y": np.array([2.0, 5.0, 7.0])}
    check_equal(looped, unroll(looped, (ELBOW,)), (ELBOW,), values)


def test_what_iterates_is_not_unrolled() -> None:
    loop = Iterate((A,), (X,), (), (A / 2,), sp.Lt(A, 1), 9, Status.IMPOSSIBLE)
    looped = Program("p", (X,), (loop,), (Output("o", A),))
    assert not is_straight(looped)
    with pytest.raises(BrokenProgram, match="is not unrolled"):
        unroll(looped, (ELBOW,))


def test_names_that_a_language_would_join_stay_apart() -> None:
    taken = Let(real("a_right"), Y + 7)
    body = (taken, Let(A, X * ELBOW.symbol + Y))
    found = unroll(program(*body, outputs={"o": A, "t": taken.name}), (ELBOW,))
    assert set(values(found)) == {"a_right", "a_right_2", "a_left"}
    verify(found)


def check_equal(looped: Program, unrolled: Program, signs: tuple[Sign, ...], values: dict[str, np.ndarray]) -> int:
    """Every slot of the unrolled program against its own run of the looped one; how many answers that were."""
    outputs, common = run(unrolled, {s.name: values[s.name] for s in unrolled.inputs})
    answers = 0
    for choice in choices(len(signs)):
        signed = {s.symbol.name: np.asarray(float(v)) for s, v in zip(signs, choice, strict=True)}
        given = {**values, **signed}
        wanted, statuses = run(looped, {s.name: given[s.name] for s in looped.inputs})
        refusal = np.broadcast_to(outputs[suffixed(REFUSAL, signs, choice)], np.shape(common)).astype(int)
        found = np.where(common == Status.OK, np.array(list(Status), dtype=object)[refusal], common)
        assert np.all(found == statuses)
        fine = np.broadcast_to(statuses == Status.OK, np.broadcast_shapes(*(np.shape(v) for v in values.values())))
        answers += int(np.sum(fine))
        for name, value in wanted.items():
            here = np.broadcast_to(outputs[suffixed(name, signs, choice)], fine.shape)
            np.testing.assert_allclose(here[fine], np.broadcast_to(value, fine.shape)[fine], rtol=1e-9, atol=1e-9)
    return answers


@cache
def kinematics(name: str) -> Kinematics:
    return kinematics_of(load(MECHANISMS / f"{name}.py"))


def with_limits(branch: Program, limits: Program) -> Program:
    """One branch, then its limits. What the limits bind gets names of its own."""
    own = {name: called(f"limit_{name.name}", name) for name in limits.bound()}
    values = {**own, **{real(o.name): o.value for o in branch.outputs}}
    checks = [rewritten(renamed(s, lambda n: own[n]), lambda e: e.xreplace(values)) for s in limits.body]
    return normalise(branch.name, (*branch.body, *checks), branch.outputs)


@pytest.mark.parametrize("name", SHAPES)
def test_every_slot_is_the_branch_of_its_signs(name: str) -> None:
    """The unrolled program answers each slot as the program of one branch does, with fewer statements."""
    kin = kinematics(name)
    signs = tuple(Sign(count(f"sigma_{b.name}"), b.names) for b in kin.branches)
    looped = with_limits(without_meeting(kin.branch), kin.limits)
    unrolled = verify(unroll(looped, signs))
    assert len(unrolled.body) < max(2, 2 ** len(signs)) * len(looped.body)
    assert check_equal(looped, unrolled, signs, random_inputs(kin, 400)) > 100


def random_inputs(kin: Kinematics, count: int) -> dict[str, np.ndarray]:
    """Poses of random axes, some of them moved off to where some or all branches end; turns and
    references at random.
    """
    random = np.random.default_rng(4)
    constants, _ = run(kin.setup, {p.name: np.asarray(p.nominal, dtype=float) for p in kin.parameters})
    machine = {name: np.broadcast_to(value, count) for name, value in constants.items()}
    axes = {}
    for joint in kin.mechanism.joints:
        low, high = (-170.0, 170.0) if joint.is_angle else (-100.0, 100.0)
        axes[joint.axis.name] = random.uniform(low, high, count)
        axes[joint.reference.name] = random.uniform(2 * low, 2 * high, count)
        axes[joint.turn.name] = random.integers(-2, 3, count).astype(float)
    pose, status = run(kin.forward, {**machine, **{k: v for k, v in axes.items() if k.startswith("axis_")}})
    stretched = random.choice([1.0, 1.0, 1.5], count)
    moved = {k: np.where(status == Status.OK, v, 1.0) * (stretched if k in "xyz" else 1.0) for k, v in pose.items()}
    return {**machine, **axes, **moved}
