"""Planted faults: each makes the test fail that is named for it, and the unchanged text does not."""

import inspect
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest
import softkin
from softkin import KinematicsError
from softkin._scalar import root

from derive.description.mechanism import Mechanism
from tests.catalogue.loop_machines import LOOPS, LoopMachine, loop_machines_of
from tests.catalogue.loops.test_type2 import Crossing, crossing_of


@dataclass(frozen=True)
class Fault:
    """A text in a generated module, and the wrong text that replaces it everywhere."""

    mechanism: str
    right: str
    wrong: str
    noticed_by: str
    """The test that must fail, by its module and name."""
    elsewhere: tuple[tuple[str, str], ...] = ()
    """The same fault where the programs of all branches in one write that formula otherwise."""

    def machines(self) -> tuple[LoopMachine, ...]:
        """The machines of the tests, each with the spoiled package."""
        mechanism = mechanism_named(self.mechanism)
        robot_class = spoiled(mechanism, (self.right, self.wrong), *self.elsewhere)
        return tuple(replace(one, robot=robot_class(**one.given)) for one in loop_machines_of(mechanism))


def mechanism_named(name: str) -> Mechanism:
    (found,) = (m for m in LOOPS if m.name == name)
    return found


def spoiled(mechanism: Mechanism, *changes: tuple[str, str]) -> type[softkin.Mechanism]:
    """The class from changed text. Each change must be somewhere, and the first in the scalar programs."""
    original = softkin.catalogue()[mechanism.name]
    short = original.__module__.rpartition(".")[2]
    names = original.__module__, f"softkin._array_programs.{short}", f"softkin._unrolled.{short}"
    texts = [text_of_module(name) for name in names]
    constants = set(_OF_THE_MACHINE.findall(texts[1]))
    texts[1] = _OF_THE_MACHINE.sub(r"\1", texts[1])
    assert changes[0][0] in texts[0], f"{names[0]} has no {changes[0][0]!r}"
    for right, _ in changes:
        assert any(right in text for text in texts), f"{short} has no {right!r}"
    texts = [_changed(text, changes) for text in texts]
    texts[1] = re.sub(rf"\b({'|'.join(constants)})\b", r"k.\1", texts[1])
    scalar, arrays, unrolled = (_loaded(f"{n} with {changes[0][1]}", t) for n, t in zip(names, texts, strict=True))
    scalar.__dict__["unrolled"] = unrolled.unrolled
    found: type[softkin.Mechanism] = getattr(scalar, original.__name__)
    programs = arrays.ArrayPrograms  # type: ignore[attr-defined]
    found._array_programs = lambda self: programs(self._constants)  # type: ignore[method-assign]
    return found


def text_of_module(name: str) -> str:
    """The text of a generated module, with every root read as the call that the programs on arrays have."""
    source = import_module(name)
    assert source.__file__ is not None
    return _INLINE_ROOT.sub(r"root(\1)", Path(source.__file__).read_text(encoding="utf-8"))


def _changed(text: str, changes: tuple[tuple[str, str], ...]) -> str:
    for right, wrong in changes:
        text = text.replace(right, wrong)
    return text


def _loaded(name: str, text: str) -> ModuleType:
    module = ModuleType(f"{name}_spoiled")
    module.__dict__["root"] = root
    sys.modules[module.__name__] = module  # named tuples and annotations look it up
    try:
        exec(compile(text, name, "exec"), module.__dict__)
    finally:
        del sys.modules[module.__name__]
    return module


_INLINE_ROOT = re.compile(r"\(sqrt\((\w+)\) if \1 > 0\.0 else 0\.0\)")
"""A root as the scalar programs have it: read as the call that the programs on arrays have."""
_OF_THE_MACHINE = re.compile(r"\bk\.(\w+)")
"""A constant as the programs on arrays have it; the others give it a name of its own."""
FIVE_BAR, TRIPOD, DELTA = "Kin_P2C_Type1", "Kin_Tripod_Rotary", "Kin_Delta_P3C_Type3"
ALIGNED = "(rod_1_x * rod_2_y - rod_1_y * rod_2_x)"
TOWARDS_THE_MODE = f"assembly_sign_by_outer_arm_squared * {ALIGNED}"
FAULTS = {
    "a knee on the other side": Fault(
        FIVE_BAR, "root(sine_square_a1) * sigma_knee_1", "-root(sine_square_a1) * sigma_knee_1",
        "test_round_trip.test_the_configuration_selects_the_same_axes",
    ),
    "a knee that has one side": Fault(
        FIVE_BAR, "root(sine_square_a1) * sigma_knee_1", "root(sine_square_a1)",
        "test_round_trip.test_the_configuration_selects_the_same_axes",
    ),
    "another byte for a knee": Fault(
        FIVE_BAR, "branch_knee_2 = -one", "branch_knee_2 = one", "test_configuration.test_bytes_say_branch_and_turn"
    ),
    "two legs exchanged": Fault(
        FIVE_BAR, "return (axis_a1, axis_a2)", "return (axis_a2, axis_a1)",
        "test_round_trip.test_every_slot_satisfies_the_closure",
    ),
    "two legs of three exchanged": Fault(
        DELTA, "return (axis_a1, axis_a2, axis_a3)", "return (axis_a1, axis_a3, axis_a2)",
        "test_round_trip.test_every_slot_satisfies_the_closure",
    ),
    "the other assembly mode in forward kinematics": Fault(
        FIVE_BAR, "root(height_square / normal_square) * assembly_sign",
        "-root(height_square / normal_square) * assembly_sign",
        "test_type2.test_forward_has_one_solution_a_side",
        (("root(height_square / normal_divisor) * assembly_sign",
            "-root(height_square / normal_divisor) * assembly_sign"),),
    ),
    "one assembly mode alone": Fault(
        DELTA, " * assembly_sign\n", "\n", "test_type2.test_forward_has_one_solution_a_side"
    ),
    "the other assembly mode not refused": Fault(
        FIVE_BAR, TOWARDS_THE_MODE, f"abs({TOWARDS_THE_MODE})", "test_type2.test_the_other_assembly_mode_is_refused"
    ),
    "a path that is not stopped": Fault(
        FIVE_BAR, TOWARDS_THE_MODE, f"abs({TOWARDS_THE_MODE})", "test_type2.test_a_path_is_stopped_before_the_crossing"
    ),
    "the least margin not looked at": Fault(
        FIVE_BAR, "type2_arms_aligned >= min_type2_margin", "type2_arms_aligned >= 0.0",
        "test_type2.test_the_least_margin_is_sharp",
    ),
    "a margin of another size": Fault(
        FIVE_BAR, "margin_arms_aligned = one_by", "margin_arms_aligned = 1.001 * one_by",
        "test_type2.test_the_least_margin_is_sharp",
    ),
    "a margin that vanishes elsewhere": Fault(
        FIVE_BAR,
        "margin_stretched_1 = (span_1_x * sin_a1 - y * cos_a1)",
        "margin_stretched_1 = (span_1_x * sin_a1 + y * cos_a1)",
        "test_margins.test_type_1_margins_are_those_of_b_and_type_2_of_a",
    ),
    "a leg that reaches too far": Fault(
        FIVE_BAR, "1.0000000000005 <= cos_swing_a2 <= 1.0000000000005", "1e12 <= cos_swing_a2 <= 1e12",
        "test_reach.test_every_answer_closes_the_loop_on_its_side",
        (("absolute(cos_swing_a2) <= 1.0000000000005", "absolute(cos_swing_a2) <= 1e12"),),
    ),
    "a leg that does not reach its end": Fault(
        FIVE_BAR, "1.0000000000005 <= cos_swing_a1 <= 1.0000000000005", "0.99 <= cos_swing_a1 <= 0.99",
        "test_margins.test_a_way_out_ends_at_a_singularity_or_a_bound",
        (("absolute(cos_swing_a1) <= 1.0000000000005", "absolute(cos_swing_a1) <= 0.99"),),
    ),
    "a slope of the wrong sign": Fault(
        FIVE_BAR, "slope_2_by_a2 = ", "slope_2_by_a2 = -",
        "test_jacobian.test_it_is_the_derivative_of_the_closure",
    ),
    "a ball joint that swings too far": Fault(
        TRIPOD, "y + shared_product) <= sin_max_angle_ball_joint", "y + shared_product) <= 1.0",
        "test_reach.test_a_ball_joint_ends_sharply",
    ),
    "a turn too many": Fault(
        FIVE_BAR, "turn_a2 - 1", "turn_a2", "test_configuration.test_a_named_turn_is_where_the_axis_is_put"
    ),
}  # fmt: skip


def the_test(fault: Fault) -> Callable[[tuple[LoopMachine, ...]], None]:
    """The test that is to fail, ready to be given machines."""
    module, _, name = fault.noticed_by.partition(".")
    folder = "catalogue.loops" if module in ("test_type2", "test_margins", "test_reach") else "catalogue"
    function = getattr(import_module(f"tests.{folder}.{module}"), name)
    wanted = inspect.signature(function).parameters

    def run(machines: tuple[LoopMachine, ...]) -> None:
        given = {"machines": machines, "mechanism": machines[0].mechanism}
        if "crossings" in wanted:
            given["crossings"] = crossings_given_to(machines)
        function(**{key: value for key, value in given.items() if key in wanted})

    return run


def crossings_given_to(machines: tuple[LoopMachine, ...]) -> list[Crossing]:
    """The ways that sound machines find: none is found by a machine that takes both modes for one."""
    ways = zip(machines, map(crossing_of, loop_machines_of(machines[0].mechanism)), strict=True)
    found = [(machine, way) for machine, way in ways if way is not None]
    if not found:
        raise LookupError("no way leads through the singularity")  # not an assertion: it is the test that must notice
    return [
        replace(
            way,
            machine=machine,
            unlimited=type(machine.robot)(**way.unlimited.parameters),
            other=type(machine.robot)(**way.other.parameters),
        )
        for machine, way in found
    ]


@pytest.mark.parametrize("what", FAULTS)
def test_a_wrong_formula_is_noticed(what: str) -> None:
    machines = FAULTS[what].machines()
    with pytest.raises((AssertionError, KinematicsError)):
        the_test(FAULTS[what])(machines)


@pytest.mark.parametrize("what", {f.noticed_by: name for name, f in FAULTS.items()}.values())
def test_the_same_text_unchanged_passes(what: str) -> None:
    """The test fails because of the fault, and not because the text is loaded from elsewhere."""
    fault = FAULTS[what]
    same = tuple((right, right) for right, _ in fault.elsewhere)
    unchanged = Fault(fault.mechanism, fault.right, fault.right, fault.noticed_by, same)
    the_test(fault)(unchanged.machines())
