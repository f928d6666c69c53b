"""The costs in the header of every unit are upper bounds of the operations counted while the text runs."""

import re
from collections.abc import Mapping
from dataclasses import astuple
from itertools import product
from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from derive.description.mechanism import Mechanism
from derive.emit.python.entries import module_name
from derive.ir.primitives import Atan2, NearestOnArc, NearestPeriod, Root, Select
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Solve, Status
from derive.ir.symbols import SCALE, real
from derive.kinematics.kinematics import Called
from derive.kinematics.parameters import machine_parameters
from derive.kinematics.sampling import sample_axes
from derive.plate.plate import home_position
from derive.report.call_cost import open_slots, worst_inverse
from derive.report.cost import Cost, cost_of, costs_of, expression_cost, solve_cost
from derive.report.self_test import self_test
from tests.mechanisms import catalogue, kinematics_of, named
from tests.text.controller import OK, Controller
from tests.text.samples import NO_TURN
from tests.text.statements import counted, counting_units
from tests.text.units import text_of
from tests.text.values import Numbers

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[2]
PYTHON = ROOT / "generated" / "python" / "softkin"
X, Y, Z = map(real, "xyz")
CELLS = tuple(product(range(6), range(6)))
ALL = tuple(m for _, m in catalogue() if m.joints)
CORNERED = tuple(m for m in ALL if m.name in ("Kin_Ac6_ThreeParallel", "Kin_ArticulatedRobot_6DOF"))
EXACT = "In addition: check of an exact frame"
REPAIR, CORNERS = "In addition: repair of a frame", "In addition: a branch at a singular pose"
COINCIDE = 3
"""The branch byte that forward kinematics writes where two branches meet: it leaves the branch open."""
POSES = 8
REACH = 500.0


def stated(mechanism: Mechanism, rows: str = r"(?:AxesTo|CartesianTo)\w+(?:, .*?)?") -> list[Cost]:
    """Rows of the table in the header: forward, inverse, and inverse with every branch open."""
    found = re.findall(f"^{rows}" + 5 * r" +(\d+)" + "$", text_of(mechanism), re.MULTILINE)
    return [Cost(*map(int, row)) for row in found]


def more(mechanism: Mechanism, row: str) -> Cost:
    """A row of what is added: nothing where there is none."""
    return sum(stated(mechanism, row), start=Cost())


def most(found: list[Cost]) -> Cost:
    """The largest of every kind."""
    return Cost(*map(max, zip(*map(astuple, found), strict=True)))


def is_within(found: Cost, bound: Cost) -> bool:
    """Whether there are at most so many of every kind."""
    return all(f <= b for f, b in zip(astuple(found), astuple(bound), strict=True))


@pytest.mark.parametrize("mechanism", ALL, ids=lambda m: m.name)
def test_no_call_costs_more_than_its_header_states(mechanism: Mechanism) -> None:
    """And the header does not exaggerate: between values it counts both sides of a choice, but those are small."""
    machine, parameters = _machine(mechanism)
    forward, inverse, automatic = _costs(mechanism, machine, _axes(mechanism, machine, parameters))
    header, repair = stated(mechanism), more(mechanism, REPAIR)
    assert len(header) == (3 if mechanism.branches else 2)
    assert is_within(more(mechanism, EXACT), repair)
    bounds = [header[0], *(row + repair for row in header[1:])]
    for found, bound in zip((forward, inverse, automatic), bounds, strict=False):
        assert is_within(most(found), bound), f"{most(found)} {bound}"
    if not mechanism.is_platform:
        found, bound = most(forward), header[0]
        assert (found.multiplications, found.divisions, found.roots, found.trigonometric) == astuple(bound)[1:]
        arcs = sum(len(s.value.atoms(Atan2)) for s in kinematics_of(mechanism).forward.body if isinstance(s, Let))
        # turns below zero, and arc tangents to the left, add once more
        assert found.additions >= bound.additions - 1 - len(mechanism.period_joints) - arcs
    if not mechanism.is_platform and mechanism.search is None:
        exact = header[1] + more(mechanism, EXACT)
        assert sum(astuple(most(inverse))) >= 0.5 * sum(astuple(exact))


@pytest.mark.parametrize("mechanism", CORNERED, ids=lambda m: m.name)
def test_a_singular_pose_costs_no_more_than_its_row_adds(mechanism: Mechanism) -> None:
    """All joints at multiples of a quarter turn: at some of these poses it costs more than anywhere else."""
    machine, parameters = _machine(mechanism)
    quarters = [90.0 * np.round(np.asarray(axes) / 90.0) for axes in _axes(mechanism, machine, parameters)]
    zero = np.zeros(len(mechanism.joints))
    _, inverse, automatic = _costs(mechanism, machine, [zero.tolist(), *(q.tolist() for q in quarters)])
    _, one, every = stated(mechanism)
    repair, corners = more(mechanism, REPAIR), more(mechanism, CORNERS)
    assert is_within(most(inverse), one + repair + corners)
    assert is_within(most(automatic), every + repair + corners * 2 ** len(mechanism.branches))
    assert not is_within(most(inverse), one + repair)


@pytest.mark.parametrize("mechanism", ALL, ids=lambda m: m.name)
def test_no_kind_of_count_is_larger_than_one_that_includes_it(mechanism: Mechanism) -> None:
    """One branch in all, the check of a frame in its repair, calls of the self-test in any call; Python agrees."""
    header = stated(mechanism)
    one, repair, corners = header[1], more(mechanism, REPAIR), more(mechanism, CORNERS)
    assert is_within(one, header[-1]) and is_within(more(mechanism, EXACT), repair)
    worst = {"AxesToCartesian": header[0], "CartesianToAxes": one + repair + corners}
    for method, with_one, without, most_of_all in _looped(mechanism):
        assert max(with_one, without) <= most_of_all == sum(astuple(worst[method]))
    module = (PYTHON / f"{module_name(mechanism.name)}.py").read_text(encoding="utf-8")
    told = re.findall(r"^ +(?:forward|inverse)(?:, all \d+ branches)?: ([^:]*?sines)", module, re.MULTILINE)
    assert [Cost(*map(int, re.findall(r"\d+", row))) for row in told] == header


_LOOPED = re.compile(
    r"(\w+)(?: with every branch named)?, all operations together: of the calls of the self-test "
    r"(?:at most )?([\w ]+?) with a solution, (?:at most )?([\w ]+?) without one; of any call at most (\d+)"
)


def _looped(mechanism: Mechanism) -> list[tuple[str, int, int, int]]:
    """What the header says of methods with loops: calls with a solution, without one, any call."""
    found = _LOOPED.findall(" ".join(text_of(mechanism).split()))
    numbers = ([int(n) if n.isdigit() else 0 for n in rest] for _, *rest in found)
    return [(method, one, other, most) for (method, *_), (one, other, most) in zip(found, numbers, strict=True)]


def test_methods_with_loops_are_told_of() -> None:
    """Platforms iterate, and one arm is searched: else nothing is compared above."""
    assert {m.name for m in ALL if _looped(m)} == {m.name for m in ALL if m.is_platform or m.search is not None}


@pytest.mark.parametrize("name", ("Softkin_Planar_3RRR", "Kin_Scara4_ZCcoupled_Type1"))
def test_a_budget_is_no_count(name: str) -> None:
    """The self-test allows for more than a call was counted to need, but never for more than any call may need."""
    kinematics = kinematics_of(named(name))
    costs, repaired = costs_of(kinematics), worst_inverse(kinematics)
    for case in self_test(kinematics).cases:
        assert 0 < case.operations < case.budget
        if case.called is Called.FORWARD:
            assert case.operations <= sum(costs.forward.counts) and case.budget <= sum(costs.forward.counts) + 120
        elif case.called is Called.INVERSE and open_slots(case, kinematics) == 1:
            assert case.operations <= sum(repaired.counts) and case.budget <= sum(repaired.counts) + 120


def test_what_was_measured_is_within_the_headers() -> None:
    """A call includes its algebra, and costs no more than its header states for a frame that is a rotation."""
    text = (ROOT / "docs/SPEED.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| [\w, -]+`(\w+)` \| (\d+) \| \d+ \| (\d+) \| (\d+) \|", text, re.MULTILINE)
    assert len(rows) == 4
    for block, *numbers in rows:
        mechanism = next(m for m in ALL if m.block_name == block)
        one, exact = stated(mechanism)[1], more(mechanism, EXACT)
        call, algebra, _ = map(int, numbers)
        assert algebra <= call <= sum(astuple(one + exact)[:4])


def _machine(mechanism: Mechanism) -> tuple[Controller, Mapping[str, float]]:
    machine = Controller(counting_units(mechanism), mechanism)
    parameters = {p.name: p.nominal for p in machine_parameters(mechanism)}
    assert machine.initialise(parameters) == OK
    return machine, parameters


def _costs(
    mechanism: Mechanism, machine: Controller, poses: list[Numbers]
) -> tuple[list[Cost], list[Cost], list[Cost]]:
    """What forward, inverse, and inverse with every branch open cost at these poses."""
    opened = len(mechanism.branches)
    forward, inverse, automatic = list[Cost](), list[Cost](), list[Cost]()
    for axes in poses:
        forward.append(counted(machine.forward, axes))
        status, pose = machine.forward(axes)
        if status == OK:
            position, rotation, data = pose
            named = tuple(1 if byte == COINCIDE else byte for byte in data[:opened]) + data[opened:]
            inverse.append(counted(machine.inverse, position, rotation, named, axes))
            automatic.append(counted(machine.inverse, position, rotation, (0,) * opened + data[opened:], axes))
    return forward, inverse, automatic


def _axes(mechanism: Mechanism, machine: Controller, parameters: Mapping[str, float]) -> list[Numbers]:
    """Axis values all over the ranges; of a platform, at poses near home."""
    if mechanism.is_platform:
        home = [float(e.subs({real(n): v for n, v in parameters.items()})) for e in home_position(mechanism)]
        places = ((home[0] + k, home[1] - 2 * k, home[2]) for k in range(3))
        count = len(mechanism.joints)
        first = (1,) * len(mechanism.branches) + (0,) * len(mechanism.period_joints)
        return [machine.inverse(place, NO_TURN, first, (0.0,) * count)[1][:count] for place in places]
    drawn = sample_axes(mechanism, {n: np.asarray(v) for n, v in (parameters | {SCALE.name: REACH}).items()}, POSES, 2)
    return np.stack([drawn[j.axis.name] for j in mechanism.joints], axis=1).tolist()


@pytest.mark.parametrize("size", range(1, 7))
def test_linear_equations(size: int) -> None:
    """Exactly what the function does, for every size: with the largest pivots in place, and out of it."""
    solve = counting_units().function("Softkin_Solve")
    for columns in range(7):
        for shift in (0, 1):
            matrix = [
                0.1 * (r * c % 5) + 9.0 * ((r + shift) % size == c) if max(r, c) < size else 0.0 for r, c in CELLS
            ]
            found = counted(solve, aMatrix=matrix, aRight=[1.0] * 36, iSize=size, iColumns=columns)
            assert found == solve_cost(size, columns)


PRIMITIVES = {
    "Softkin_Root": (Root(X), {"dValue": (2.0,)}),
    "Softkin_Atan2": (Atan2(Y, X), {"dY": (1.0, -2.0), "dX": (-1.5, -3.0)}),
    "Softkin_NearestPeriod": (NearestPeriod(X, Y), {"dValue": (-200.0, 10.0), "dCentre": (0.0, 300.0)}),
    "Softkin_NearestOnArc": (
        NearestOnArc(X, Y, Z),
        {"dAngle": (-9.0, 1.0), "dCentre": (0.0, 2.0), "dHalf": (0.1, 1.0)},
    ),
}


@pytest.mark.parametrize("name", PRIMITIVES)
def test_primitives(name: str) -> None:
    expression, given = PRIMITIVES[name]
    function = counting_units().function(name)
    choices = product(*given.values())
    assert most([counted(function, **dict(zip(given, values, strict=True))) for values in choices]) == expression_cost(
        expression
    )


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (X - Y, Cost(1)),
        (-X, Cost()),
        (2 * X - Y / 3, Cost(1, 1, 1)),
        (X / 2, Cost(0, 1)),
        (X / (Y * Z), Cost(0, 1, 1)),
        (1 / X, Cost(0, 0, 1)),
        ((X + Y) ** 2, Cost(2, 1)),
        (-3 * X * Y / (7 * Z**2), Cost(0, 4, 1)),
        (sp.sin(X) * sp.cos(Y) + Root(X), Cost(1, 1, 0, 1, 2)),
        (Select(sp.Gt(X + Y, 0), X * Y, sp.sin(X)), Cost(1, 1, 0, 0, 1)),
        (sp.And(sp.Le(sp.Abs(X - 1), Y), sp.Gt(X * Z, 0)), Cost(1, 1)),
    ],
)
def test_expressions(expression: sp.Basic, expected: Cost) -> None:
    assert expression_cost(expression) == expected


def test_statements() -> None:
    total, half = real("total"), real("half")
    shared = Program("shared", (X,), (Let(half, X / 2),), (Output("half", half + 1),))
    body = (
        Call(shared, ((X, Y * Z),), (half,)),
        Iterate(
            (total,), (X + Y,), (Let(real("step"), total * X),), (total - 1,), sp.Le(total + X, 0), 9, Status.IMPOSSIBLE
        ),
        Solve((real("answer"),), (X * Y,), (Z,)),
        Require(sp.Gt(X + Y, 0), Status.UNREACHABLE),
    )
    program = Program("whole", (X, Y, Z), body, (Output("answer", real("answer") / half),))
    called, loop, solved = Cost(1, 2), Cost(1) + Cost(2, 1) * 9, Cost(0, 1) + solve_cost(1, 1)
    assert cost_of(program) == called + loop + solved + Cost(1) + Cost(divisions=1)


def test_the_bound_of_an_iteration_is_stated() -> None:
    """The description of a block with an iteration states the most passes."""
    texts = {m.name: text_of(m) for m in ALL if m.is_platform or m.search is not None}
    assert len(texts) >= 2
    for text in texts.values():
        assert re.search(r"at most \d+ passes, all of which", text)
