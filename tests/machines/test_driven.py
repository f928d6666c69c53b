"""Machines of nobody's catalogue whose joints loops move, against loops that are closed by root finding."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import softkin
from softkin import KinematicsError, Status
from sympy import cos

from derive.description.validate import validate
from derive.frames import Ry, Rz, Tx, Tz
from derive.mechanism import DescriptionError, Mechanism, Task, distance, driven, length, linear, rotary, sign
from tests.catalogue import test_forward, test_jacobian
from tests.catalogue.driven_machines import DrivenClosure, DrivenMachine
from tests.catalogue.machines import Machine
from tests.languages.language import Language
from tests.machines.both import forward_in_both, inverse_in_both
from tests.machines.made import built_of, imported_class
from tests.machines.spoken import EVERY_OTHER
from tests.text.controller import OK, Controller
from tests.text.units import compiled_text

THIGH, SHANK = length("thigh", "Hip to knee", nominal=400.0), length("shank", "Knee to foot", nominal=380.0)
HEEL = length("heel", "Knee to the rod, on the shank", nominal=70.0)
CRANK, ROD = length("crank", "Crank of the knee", nominal=70.0), length("rod", "Rod of the knee", nominal=310.0)
SIDE = sign("knee_side", "+1: the rod is behind the knee; -1: it crosses")
CRANK_SIDE = sign("crank_side", "Which of its two angles the crank has")
HIP, KNEE = rotary("H", "Thigh about Y", nominal=60.0), rotary("K", "Shank about Y", nominal=50.0)
S1 = linear("S1", "Cylinder of the hip", nominal=154.4)
M2 = rotary("M2", "Crank about Y", nominal=60.0)
LEG = Mechanism(
    name="DrivenLeg",
    parameters=(THIGH, SHANK, HEEL, CRANK, ROD, SIDE, CRANK_SIDE),
    joints=(S1, M2),
    chain=Ry(HIP) * Tx(THIGH) * Ry(KNEE) * Tx(SHANK),
    drives=(
        driven(HIP, by=S1, start=Tx(-80) * Tz(-60), tip=Ry(HIP) * Tx(150) * Tz(-30)),
        driven(
            KNEE,
            by=M2,
            start=Tx(-300) * Ry(M2) * Tx(CRANK),
            tip=Ry(KNEE) * Tx(HEEL),
            length=ROD,
            side=SIDE,
            by_side=CRANK_SIDE,
        ),
    ),
    task=Task("xz"),
)
"""A leg: a cylinder at the hip, and a crank on the thigh with a rod for the knee; its modes are parameters."""

SLIDE = linear("H", "Slide along X", nominal=363.0)
M1 = rotary("M1", "Crank about Y", nominal=-30.0)
A2 = rotary("A2", "Arm about Z")
BESIDE = distance("crank_height", "Crank above the slide", nominal=30.0)
ARM = length("arm", "Arm", nominal=90.0)
SHAPER = Mechanism(
    name="DrivenShaper",
    parameters=(CRANK, ROD, BESIDE, ARM),
    joints=(M1, A2),
    chain=Tx(SLIDE) * Rz(A2) * Tx(ARM),
    drives=(driven(SLIDE, by=M1, start=Tz(BESIDE) * Ry(M1) * Tx(CRANK), tip=Tx(SLIDE), length=ROD),),
    task=Task("xy"),
)
"""A crank with a rod that moves a slide, which carries an arm."""


OFFSETS = {"DrivenLeg": {"offset_s1": 12.0, "offset_m2": -9.0}, "DrivenShaper": {"offset_m1": 15.0, "offset_a2": -40.0}}
MODES: dict[str, list[dict[str, int]]] = {
    "DrivenLeg": [{"knee_side": a, "crank_side": b} for a in (1, -1) for b in (1, -1)],
    "DrivenShaper": [{}],
}

OPEN = {"DrivenLeg": (900.0, 50.0), "DrivenShaper": (15.0 + 90.0, 0.0)}
"""Axes at which a loop does not close."""


@cache
def robot_class(name: str) -> type[softkin.Mechanism]:
    mechanism = validate({m.name: m for m in (LEG, SHAPER)}[name])
    return imported_class(mechanism, built_of(mechanism))


def machines() -> list[object]:
    return [
        pytest.param(m, mode, id=f"{m.name}-{'-'.join(map(str, mode.values()))}")
        for m in (LEG, SHAPER)
        for mode in MODES[m.name]
    ]


def machine_of(mechanism: Mechanism, mode: dict[str, int]) -> DrivenMachine:
    given = {p.name: p.nominal for p in mechanism.parameters} | OFFSETS[mechanism.name] | mode
    robot = robot_class(mechanism.name)(**given)
    reach = sum(p.nominal for p in mechanism.parameters if p.unit == "u")
    closure = DrivenClosure(mechanism, robot.parameters, reach)
    return DrivenMachine(mechanism.name, mechanism, given, robot, closure, reach)


@pytest.mark.parametrize(("mechanism", "mode"), machines())
@pytest.mark.parametrize(
    "asked", (test_forward.test_forward_satisfies_the_closure, test_jacobian.test_it_is_the_derivative_of_the_closure)
)
def test_what_the_catalogue_is_asked(
    asked: Callable[[tuple[Machine, ...]], None], mechanism: Mechanism, mode: dict[str, int]
) -> None:
    asked((machine_of(mechanism, mode),))


@pytest.mark.parametrize(("mechanism", "mode"), machines())
def test_the_inverse_has_every_solution(mechanism: Mechanism, mode: dict[str, int]) -> None:
    """As many as joint values that reach the pose have loops that close on their sides."""
    machine = machine_of(mechanism, mode)
    axes = machine.draw(60, np.random.default_rng(2))
    counts = []
    for row, position, rotation in zip(axes, *machine.closure.poses(axes), strict=True):
        slots = [s.axes for s in machine.robot.inverse_all((position, rotation), row) if s.status is Status.OK]
        expected = _every(machine, position)
        assert len(slots) == len(expected)
        assert min(np.abs(np.subtract(s, row)).max() for s in slots) < 1e-7
        error = np.abs(machine.robot.forward_batch(np.array(slots))[0] - position)
        assert error.max() < 1e-9 * machine.reach
        counts.append(len(slots))
    assert min(counts) >= 1
    assert max(counts) == 2 or -1 in mode.values()  # with a crossed rod the knee bends one way alone


def _every(machine: DrivenMachine, position: np.ndarray) -> list[np.ndarray]:
    """The axis values of all joint values that reach a position, by hand."""
    values = machine.robot.parameters
    if machine.mechanism is LEG:
        x, z = position[0], -position[2]
        span = (x * x + z * z - values["thigh"] ** 2 - values["shank"] ** 2) / (2 * values["thigh"] * values["shank"])
        knees = [s * np.arccos(np.clip(span, -1, 1)) for s in (1, -1)]
        ends = [values["thigh"] + values["shank"] * np.exp(1j * knee) for knee in knees]
        joints = [[np.angle(complex(x, z) / end), knee] for end, knee in zip(ends, knees, strict=True)]
    else:
        sine = position[1] / values["arm"]
        turns = [np.arcsin(sine), np.pi - np.arcsin(sine)]
        joints = [[position[0] - values["arm"] * np.cos(turn), turn] for turn in turns]
    axes = machine.closure.axes(np.array(joints))
    return [row for row in axes if np.isfinite(row).all()]


@EVERY_OTHER
@pytest.mark.parametrize("mechanism", [LEG, SHAPER], ids=lambda one: one.name)
def test_other_languages_answer_as_python(language: Language | None, mechanism: Mechanism) -> None:
    """In every mode: poses, all solutions and the Jacobian through the loops, and a refusal where a loop is open."""
    built, known = built_of(validate(mechanism)), validate(mechanism)
    program = language.of(known) if language else compiled_text(f"{known.name}.st", built.parts["st"]["text"])
    for mode in MODES[mechanism.name]:
        machine = machine_of(mechanism, mode)
        robot, axes = machine.robot, machine.draw(8, np.random.default_rng(4)).tolist()
        poses = [(row, robot.forward(row)[0]) for row in axes]
        assert robot.forward_batch([OPEN[mechanism.name]])[3].tolist() == [Status.IMPOSSIBLE]
        if language is None:
            _confirm_block(Controller(program, known), machine, poses)
            continue
        calls = [[call, row] for call in ("forward", "jacobian") for row in axes]
        calls += [["inverseAll", {"position": f.position, "rotation": f.rotation}, row] for row, f in poses]
        given = {"parameters": dict(robot.parameters), "calls": [["forward", OPEN[mechanism.name]], *calls]}
        refused, *found = language.ask(program, [given])[0]["found"]
        assert refused["status"] == Status.IMPOSSIBLE
        for k, (row, frame) in enumerate(poses):
            there, rates, every = found[k :: len(axes)]
            assert there["frame"]["position"] == pytest.approx(frame.position, abs=1e-9)
            assert np.allclose(rates["rows"], robot.jacobian(row), rtol=1e-9, atol=1e-9)
            for one, other in zip(robot.inverse_all(frame, row), every["slots"], strict=True):
                assert int(one.status) == other["status"]
                assert one.axes is None or other["axes"] == pytest.approx(one.axes, abs=1e-7)


def _confirm_block(block: Controller, machine: DrivenMachine, poses: list[tuple[list[float], softkin.Frame]]) -> None:
    """The same of a block, whose Jacobian has a row for each of six coordinates, in the order of the task."""
    assert block.initialise(machine.robot.parameters) == OK
    assert block.forward(OPEN[machine.mechanism.name])[0] == Status.IMPOSSIBLE.softmotion
    for row, frame in poses:
        assert forward_in_both(block, machine.robot, row, machine.reach) is not None
        assert inverse_in_both(block, machine.robot, frame, row)
        expected = np.array(machine.robot.jacobian(row))
        status, rates = block.jacobian(row)
        assert status == OK and np.allclose(np.array(rates)[:2, :2], expected, rtol=1e-9, atol=1e-9)


def test_both_assembly_modes_have_the_same_axes_and_other_poses() -> None:
    one, other = (machine_of(LEG, {"knee_side": side, "crank_side": 1}) for side in (1, -1))
    axes = (170.0, 50.0)
    assert abs(one.robot.forward(axes)[0].position[0] - other.robot.forward(axes)[0].position[0]) > 1.0


def test_a_loop_that_does_not_close_has_a_status() -> None:
    robot = machine_of(LEG, {}).robot
    for cylinder in (20.0, 900.0, -240.0):
        with pytest.raises(KinematicsError) as refused:
            robot.forward((cylinder, 50.0))
        assert refused.value.status is Status.IMPOSSIBLE
        assert "the mechanism cannot be assembled there" in str(refused.value)
    assert robot.forward_batch([(900.0, 50.0), (170.0, 50.0)])[3].tolist() == [Status.IMPOSSIBLE, Status.OK]


def test_dead_points_are_where_margins_vanish() -> None:
    """A lever in line with its cylinder: the joint is free there. A crank in line with its rod moves nothing."""
    robot = machine_of(LEG, {}).robot
    shortest = abs(np.hypot(80.0, 60.0) - np.hypot(150.0, 30.0)) + robot.parameters["offset_s1"]
    near, far = (robot.singularity((shortest + shift, 50.0)) for shift in (1e-7, 60.0))
    assert near.is_singular
    assert abs(near.margins["lever_h"]) < 1e-3 < abs(far.margins["lever_h"])
    assert {"lever_h", "crank_m2", "lever_k"} < set(robot.MARGINS)


REFUSED: dict[str, tuple[Callable[[], Mechanism], str]] = {
    "a driven joint without a loop": (
        lambda: replace(LEG, drives=LEG.drives[:1], joints=(S1,)),
        "chain reads 'k', which is not a joint or a parameter of this mechanism",
    ),
    "two loops for one joint": (
        lambda: replace(LEG, drives=(*LEG.drives, replace(LEG.drives[0], by=M2)), joints=(S1, M2)),
        "joint 'H' is driven 2 times: one loop decides it",
    ),
    "one motor for two joints": (
        lambda: replace(LEG, drives=(LEG.drives[0], replace(LEG.drives[1], by=S1)), joints=(S1, M2)),
        "'S1' drives 2 joints: give each an actuator of its own",
    ),
    "a driven joint with a motor": (
        lambda: replace(LEG, joints=(S1, M2, HIP)),
        "joint 'H' is driven by 'S1': leave it out of joints=, it has no motor",
    ),
    "a motor that is not there": (
        lambda: replace(LEG, joints=(S1,)),
        "joint 'K' is driven by 'M2', which is no joint of this mechanism",
    ),
    "a loop that is open": (
        lambda: replace(LEG, joints=(replace(S1, nominal=500.0), M2)),
        "the loop of joint 'H' is open at the nominal values of H (60)",
    ),
    "a loop without its motor": (
        lambda: replace(LEG, drives=(replace(LEG.drives[0], length=THIGH.symbol), LEG.drives[1]), joints=(S1, M2)),
        "the loop of joint 'H' does not read 'S1'",
    ),
    "a loop that a third joint moves": (
        lambda: replace(LEG, drives=(replace(LEG.drives[0], start=Tx(M2)), LEG.drives[1]), joints=(S1, M2)),
        "the loop of joint 'H' reads 'm2': only 'H' and 'S1' may move its ends",
    ),
    "a loop around a closure": (
        lambda: replace(LEG, chain=None, closure=(cos(HIP),), joints=(S1, M2)),
        "drives= are loops that move joints of a chain",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refusals(name: str) -> None:
    wrong, message = REFUSED[name]
    with pytest.raises(DescriptionError) as refused:
        validate(wrong())
    assert message in str(refused.value)
