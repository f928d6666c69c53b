"""Long statements are cut into named parts, and long names are shortened; the values stay the same."""

import numpy as np
import pytest
import sympy as sp

from derive.algebra.angle_sums import name_of
from derive.equations.known_turns import Side
from derive.ir.interpret import run
from derive.ir.passes import normalise
from derive.ir.primitives import Root, Select
from derive.ir.program import Let, Output, Program
from derive.ir.symbols import Names, real
from derive.lowering.passes import lowered

INPUTS = [real(f"measured_length_{i}") for i in range(150)]
RESULT = real("result")
NESTED = Root(sum((a * Root(b + c) for a, b, c in zip(INPUTS, INPUTS[50:], INPUTS[100:], strict=False)), INPUTS[0]))
LONG = {
    "a sum": sum((a * b - 2 for a, b in zip(INPUTS, INPUTS[75:], strict=False)), sp.S.Zero),
    "deep": Root(NESTED + INPUTS[7]) / (NESTED + 3),
    "a choice": Select(sp.Gt(sum(INPUTS[:60]), 0), NESTED, sum(INPUTS[90:])),
}


def program(value: sp.Expr) -> Program:
    return normalise("program", [Let(RESULT, value, "what it is")], [Output("result", RESULT)])


@pytest.mark.parametrize("kind", LONG)
def test_a_long_statement_is_cut_into_named_parts(kind: str) -> None:
    """Each part is short, has a name of its own, and the result is the same."""
    whole = program(LONG[kind])
    (cut,), _ = lowered([whole], ())
    assert len(str(LONG[kind])) > 1500
    assert max(len(str(let.value)) for let in cut.lets()) < 450
    assert len(cut.body) > 4 and sum(let.note == "what it is" for let in cut.lets()) == 1
    values = {s.name: np.linspace(1.0, 2.0, 5) + k for k, s in enumerate(INPUTS)}
    before, after = (run(p, {s.name: values[s.name] for s in p.inputs})[0]["result"] for p in (whole, cut))
    assert np.allclose(before, after, rtol=1e-13)


def test_what_is_short_stays_as_it_is() -> None:
    (same,), _ = lowered([program(sum(INPUTS[:8]))], ())
    assert len(same.body) == 1


def test_a_long_name_is_shortened_and_stays_unique() -> None:
    """Two long names with the same ends are numbered; a name of usual length is kept."""
    names = Names(())
    first, second = (names.fresh(f"sum_in_r22_from_{word * 20}_{'turn_x_' * 9}tried").name for word in ("ab_", "cd_"))
    third = names.fresh(f"sum_in_r22_from_{'ab_' * 21}{'turn_x_' * 9}tried").name
    assert len({first, second, third}) == 3 and max(map(len, (first, second, third))) <= 84
    assert first.startswith("sum_in_r22_from_ab") and first.endswith("turn_x_tried") and "__" not in first
    assert names.fresh("cos_a2").name == "cos_a2" and names.fresh("x" * 200).name == f"{'x' * 40}_{'x' * 40}"


def test_the_name_of_a_frame_does_not_grow_with_the_chain() -> None:
    """A frame behind many joints with long names is named by the last of them, one before many by the first."""
    joints = tuple(f"a{k}_base_turn_z" for k in range(1, 6))
    assert Side("from", "base", joints[:1]).suffix == "_from_a1_base_turn_z"
    assert Side("from", "base", joints).suffix == "_from_base_to_a5_base_turn_z"
    assert Side("before", "flange", joints, 1).suffix == "_before_a1_base_turn_z_to_flange_turned"
    again = (*joints, joints[0])  # an angle of two links
    assert Side("from", "base", again).suffix == "_from_base_to_a1_base_turn_z_2"
    assert Side("before", "flange", again).suffix == "_before_a1_base_turn_z_2_to_flange"
    short = tuple(f"a{k}" for k in range(1, 7))
    assert Side("before", "flange", short).suffix == f"_before_{name_of(tuple((real(n), 1) for n in short))}"
