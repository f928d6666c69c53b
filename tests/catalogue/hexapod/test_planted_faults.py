"""The tests of this folder can fail: their comparisons notice a unit, or a program, with one fault."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from softkin import Hexapod

from derive.ir.program import Call, Program
from derive.ir.program import Status as Outcome
from derive.mechanisms.kin_hexapod import MECHANISM
from tests.catalogue.hexapod.machines import Machine, bounded, found_from, machines, search_changed, without_mode
from tests.harness.faults import StFault
from tests.harness.library import StError, compile_st
from tests.text.breakage import Break, texts
from tests.text.hexapod.blocks import made
from tests.text.hexapod.test_structured_text import compare_some, in_the_other_mode

pytestmark = pytest.mark.slow

_SEARCH, _INVERSE, _JACOBIAN, _FORWARD, _MARGINS = (
    f"METHOD {name}"
    for name in (
        "PRIVATE FindPlatform",
        "PROTECTED SolveBranch",
        "PROTECTED FindJacobian",
        "PROTECTED FindPose",
        "PROTECTED FindMargins",
    )
)


WRONG = {
    "a moment with another arm": Break(_SEARCH, "along3.dZ*arm3Y", "along3.dZ*arm2Y"),
    "a joint of another leg": Break(_SEARCH, "arm4X + x - base4X", "arm4X + x - base5X"),
    "an entry of the rotation": Break(_SEARCH, "platform.rot[2, 3] := ", "platform.rot[2, 3] := 1.0E-9 + "),
    "a rotation on the other side": Break(_SEARCH, "start.rot[1, 2]*turned11", "start.rot[2, 1]*turned11"),
    "an offset": Break(_SEARCH, "l5 := a.a4 - axes[4].offset", "l5 := a.a4"),
    "too few passes": Break(_SEARCH, "FOR iteration := 1 TO 20 DO", "FOR iteration := 1 TO 3 DO"),
    "a tolerance": Break(_SEARCH, "(fit) AND (fitted)", "(fit) OR (size < 0.05)"),
    "a pass that changes nothing": Break(_SEARCH, "x := x + oneByStretch*xRate", "x := x"),
    "an output that is never written": Break(_SEARCH, "platform.rot[3, 1] := ", "startArm1X := "),
    "the other assembly mode": Break(_SEARCH, "determinant > 0.0", "determinant < 0.0"),
    "two outputs exchanged": Break(_FORWARD, "v.dX := platform.v.dX;\nv.dY := platform.v.dY;",
        "v.dX := platform.v.dY;\nv.dY := platform.v.dX;"),
    "another start": Break("METHOD PROTECTED ReadInputs", "home.v.dX := dHomeX", "home.v.dX := dHomeX + 1.0E6"),
    "a refusal that is not handed on": Break(_FORWARD, ":= outcome;",
        ":= Softkin_Names.NoError;"),
    "a column of the Jacobian": Break(_JACOBIAN, "coefficients[2, 4] := platform.moment2.dX",
        "coefficients[2, 4] := platform.moment3.dX"),
    "a Jacobian per platform radius": Break(_JACOBIAN, "*oneByPlatformRadius", ""),
    "a margin": Break(_MARGINS, "aMargins[0] := ", "aMargins[0] := 1.0E-4*"),
    "a length": Break(_INVERSE, "span2Y*span2Y", "span2X*span2Y"),
    "a cone": Break(_INVERSE, "alongBaseCone1 >= l1*leastCosBase", "alongBaseCone1 >= l1*0.999999"),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_text_is_noticed(name: str) -> None:
    """By the comparison with Python at ordinary poses of a machine without symmetry, and where nothing can be found."""
    machine, library = machines()["asymmetric"], compile_st(texts(WRONG[name], MECHANISM))
    block = made(machine, library)
    with pytest.raises((AssertionError, StFault)):
        compare_some(machine, block)
        for axes in ((1e6,) * 6, in_the_other_mode()):
            assert block.forward(axes)[1] is None


def test_a_memory_is_refused() -> None:
    """A search that keeps where it ended for the next call cannot even be compiled."""
    with pytest.raises(StError, match="only Initialize and AxisSettings may write"):
        compile_st(texts(Break(_SEARCH, "x := x + oneByStretch*xRate;", "home.v.dX := x;"), MECHANISM))


def in_reach(program: Program, machine: Machine) -> bool:
    """Whether a search from the neighbouring pose ends in the pose that was commanded."""
    positions, turns = (values[::25] for values in machine.path())
    found, status = found_from(program, machine, machine.axes(positions, turns), positions, turns)
    near, ok = found_from(program, machine, machine.axes(positions, turns)[1:], positions[:-1], turns[:-1])
    same = np.abs(found - positions).max() < 1e-8 and np.abs(near - positions[1:]).max() < 1e-8
    return bool(same and (status == Outcome.OK).all() and (ok == Outcome.OK).all())


def _with_argument(name: str, value: float) -> Program:
    """The search with one argument fixed."""
    program = search_changed(lambda s: s)
    body = tuple(
        replace(s, given=tuple((n, v * 0 + value if n.name == name else v) for n, v in s.given))
        if isinstance(s, Call)
        else s
        for s in program.body
    )
    return replace(program, body=body)


@pytest.mark.parametrize(
    "program", [lambda: bounded(2), lambda: _with_argument("axis_l3", 700.0), lambda: _with_argument("begin_r21", 0.7)]
)
def test_a_wrong_program_is_noticed(program: Callable[[], Program]) -> None:
    """The test of all poses fails for each wrong program, and passes for the right one."""
    assert in_reach(search_changed(lambda s: s), machines()["lopsided"])
    assert not in_reach(program(), machines()["lopsided"])


def test_the_test_of_the_mode_decides() -> None:
    """Without it the far poses of the asymmetric machine are answered in both modes."""
    machine = machines()["asymmetric"]
    axes, home = np.array([in_the_other_mode()]), (machine.home[None, :3], machine.home_turn[None])
    assert found_from(without_mode(), machine, axes, *home)[1] == Outcome.OK
    assert found_from(search_changed(lambda s: s), machine, axes, *home)[1] == Outcome.IMPOSSIBLE


def test_a_platform_given_wrongly_is_another_machine() -> None:
    """The lengths are those of the joints that were given: a joint elsewhere changes them."""
    machine = machines()["lopsided"]
    for name in machine.given:
        if name.startswith(("base", "platform")):
            other = Hexapod(**{**machine.given, name: machine.given[name] + 1.0})
            pose = (machine.home[:3], machine.home_turn)
            leg = int(name.split("_")[1]) - 1
            changed = ~np.isclose(other.inverse(pose), machine.axes(*pose), rtol=1e-12)
            assert changed.tolist() == [i == leg for i in range(6)]
