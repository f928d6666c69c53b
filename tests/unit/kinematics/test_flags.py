"""No flag, number of a turn, status or state is a real number in any program of any mechanism."""

from collections.abc import Iterator

import pytest
import sympy as sp

from derive.description.mechanism import Mechanism, Role
from derive.equations.choices import input_of, with_choices
from derive.ir.primitives import Select
from derive.ir.program import Iterate, Let, Program, Statement
from derive.ir.symbols import Flag, flag, is_condition, is_count, real
from derive.kinematics.kinematics import Kinematics
from tests.mechanisms import kinematics_of, named

pytestmark = pytest.mark.long("Hexapod")

CHOSEN = ("Kin_Scara4_CCZC_ZCcoupled", "Kin_GantryCutter2", "Kin_Hexapod")


@pytest.fixture(scope="module", params=CHOSEN)
def kinematics(request: pytest.FixtureRequest) -> Kinematics:
    """Machines with flags, signs, turns and loops."""
    return kinematics_of(named(request.param))


def _all(kin: Kinematics) -> Iterator[tuple[Program, Statement]]:
    for program in (kin.setup, *kin.shared, *kin.programs):
        for statement in program.body:
            yield program, statement
            yield from ((program, s) for s in (statement.step if isinstance(statement, Iterate) else ()))


def test_no_real_is_one_or_zero_by_a_condition(kinematics: Kinematics) -> None:
    flags = {(sp.Integer(1), sp.Integer(0)), (sp.Integer(0), sp.Integer(1))}
    lets = [s for _, s in _all(kinematics) if isinstance(s, Let)]
    assert not [s for s in lets if isinstance(s.value, Select) and s.value.args[1:] in flags]
    assert not any(
        isinstance(node, Select) and node.args[1:] in flags for s in lets for node in sp.preorder_traversal(s.value)
    )


def test_parameters_are_read_in_their_types(kinematics: Kinematics) -> None:
    inputs = {s.name: s for s in kinematics.setup.inputs}
    for parameter in kinematics.parameters:
        name = inputs[parameter.name]
        assert name == input_of(parameter)
        assert isinstance(name, Flag) == (parameter.role is Role.FLAG) and is_count(name) == (
            parameter.role is Role.SIGN
        )
    constants = {o.name: o.value for o in kinematics.setup.outputs}
    assert all(is_condition(constants[f"unlimited_{j.key}"]) for j in kinematics.mechanism.joints)
    assert all(is_condition(constants[f"single_{j.key}"]) for j in kinematics.mechanism.joints if j.multi_turn)
    for program in kinematics.programs:
        names = {s.name: s for s in program.inputs}
        assert all(is_count(names[s.name]) for s in (j.turn for j in kinematics.period_joints) if s.name in names)
        assert all(is_count(names[f"sigma_{b.name}"]) for b in kinematics.branches if f"sigma_{b.name}" in names)


@pytest.mark.long
def test_a_search_and_its_loop_count_and_ask() -> None:
    kin = kinematics_of(named("Kin_Ac6_RZRYRYRXRYRZ_J6Offset"))
    (search,) = (p for p in kin.shared if p.name == "find_root")
    assert is_condition(search.outputs[0].value)
    assert all(is_count(s) for s in search.inputs if s.name.startswith("wanted_"))
    (loop,) = (s for s in search.body if isinstance(s, Iterate))
    assert {"stage", "direction", "side", "rounds_before", "trials", "passes_left"} <= {
        s.name for s in loop.state if is_count(s)
    }
    assert [s.name for s in loop.state if isinstance(s, Flag)] == ["is_newton", "was_mirrored", "kept_an_angle"]


X, Y, Z, SWAP, IS_SWAPPED = (*map(real, ("x", "y", "z", "swap_xy")), flag("swap_xy"))


@pytest.mark.parametrize(
    "value, expected",
    [
        (X * (1 - SWAP) + Y * SWAP, Select(IS_SWAPPED, Y, X)), (SWAP * X, Select(IS_SWAPPED, X, 0)),
        (Z * (1 - 2 * SWAP), Z * Select(IS_SWAPPED, -1, 1)), (1 - 2 * SWAP > 0, sp.Not(IS_SWAPPED)),
        (SWAP > 0, IS_SWAPPED),
        (sp.sin(Z + SWAP * X), sp.sin(Select(IS_SWAPPED, X + Z, Z))),
    ],
)  # fmt: skip
def test_what_calculates_with_a_flag_becomes_a_choice(value: sp.Basic, expected: sp.Basic) -> None:
    mechanism: Mechanism = named("MC_KIN_TYPE_12_XY")
    body = (Let(flag("f") if is_condition(value) else real("v"), value),)
    program = Program("p", tuple(sorted(value.free_symbols, key=str)), body, ())
    (let,) = with_choices(program, mechanism.parameters).lets()
    assert let.value == expected
    for number in (0, 1):
        settled = let.value.xreplace({IS_SWAPPED: sp.true if number else sp.false})
        assert settled == value.xreplace({SWAP: sp.Integer(number)})
