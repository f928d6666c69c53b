"""Random machines and poses in the field, and the equations that must hold there."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from random import Random

import sympy as sp

from derive.description.amounts import with_exact_angles
from derive.description.mechanism import Joint, Mechanism, Parameter, Role, Turning
from derive.geometry.frames import Motion
from derive.ir.program import Program
from derive.ir.symbols import MIN_TYPE2_MARGIN, ROTATION_ENTRIES
from derive.kinematics.kinematics import Exact, Kinematics
from derive.witness.disagreement import Disagreement
from derive.witness.exact.described import as_fractions, is_rounded
from derive.witness.exact.field import PRIME, NoRoot, Pair, on_circle, root
from derive.witness.exact.runs import Known, Run, Signs, evaluated
from derive.witness.exact.values import ONE, ZERO, Angles, Fractional, NotAlgebraic, NotPlanted, Value, fraction
from derive.witness.frames import as_in

TRIALS = 3
_STEPS = 500
"""Random machines that are drawn, and programs that are run: they take some 2 s."""
_ROUNDED = "numbers that its form computes are rounded"
_LARGEST = 10**9
"""The largest multiple of which angles are drawn."""
_POSE = ("x", "y", "z", *(r.name for r in ROTATION_ENTRIES))
Columns = list[list[int]]
_SETTINGS = ("warning_distance", MIN_TYPE2_MARGIN)
_RATIOS = (Role.PITCH, Role.GEAR, Role.COUPLING, Role.RATIO, Role.TRANSMISSION)


@dataclass
class Trial:
    """One random machine, and one pose of it."""

    kin: Kinematics
    described: Mechanism
    angles: Angles
    degree: Value
    inputs: Known
    """The parameters, by the names of programs."""
    own: dict[sp.Symbol, Value]
    """The parameters, by the symbols of the description: the symbol of a joint may have the same name."""
    axes: dict[str, Value]
    """The planted axis values."""
    pose: dict[str, Value]
    steps: Iterator[int]
    """The steps that are left."""

    def joints(self, axes: Mapping[str, Value]) -> dict[str, Value]:
        """The joint values of the description."""
        return self._joints(self.described, axes, {}, self.own)

    def machine_joints(self) -> dict[str, Value]:
        """The planted joint values of the machine, which may have other gears: nothing is measured by them."""
        numbers = {name: _as_number(value) for name, value in self.inputs.items()}
        return self._joints(self.kin.mechanism, self.axes, numbers, {})

    def _joints(
        self, of: Mechanism, axes: Mapping[str, Value], known: Mapping[str, Value], own: Mapping[sp.Symbol, Value]
    ) -> dict[str, Value]:
        motors: dict[str, Value] = {}
        for joint in of.joints:
            offset = self.inputs[joint.offset.name]
            assert isinstance(offset, Value)
            motor = axes[joint.axis.name] + -offset
            motors[joint.motor.name] = motor * self.degree if joint.in_degrees else motor
        expressions = [j.motor * j.ratio + j.coupling for j in of.joints]
        values = evaluated(expressions, {**known, **motors}, self.angles, self.degree, own)
        return {j.symbol.name: v for j, v in zip(of.joints, values, strict=True)}

    def equations(self, axes: Mapping[str, Value], pose: Mapping[str, Value]) -> list[int]:
        """The closure of the description: zeros if it holds."""
        joints = self.joints(axes)
        if self.described.chain is not None:
            frame = frame_of(self, joints)
            return [(frame[n].number - pose[n].number) % PRIME for n in self.commanded()]
        stated = [sp.sympify(e) for e in self.described.equations]
        if self.described.heading is not None:
            heading = self.described.heading
            stated += [sp.cos(heading) - ROTATION_ENTRIES[0], sp.sin(heading) - ROTATION_ENTRIES[3]]
        values = evaluated(stated, {**joints, **pose}, self.angles, self.degree, self.own)
        return [v.number for v in values]

    def commanded(self) -> tuple[str, ...]:
        """The entries of the pose that a chain must meet."""
        turning = self.described.task.turning
        if turning is Turning.NONE:
            return tuple(self.described.task.position)
        column = ("r13", "r23", "r33")
        is_column = turning in (Turning.DIRECTION, Turning.PITCH)
        return (*self.described.task.position, *(column if is_column else _POSE[3:]))


def frame_of(trial: Trial, joints: Mapping[str, Value]) -> dict[str, Value]:
    """The frame at the end of the chain of the description, multiplied out factor by factor."""
    assert trial.described.chain is not None
    factors = trial.described.chain.factors
    amounts = evaluated([f.amount for f in factors], joints, trial.angles, trial.degree, trial.own)
    position, columns = [0, 0, 0], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    half_a_turn = trial.degree * fraction(Fraction(180))
    for factor, amount in zip(factors, amounts, strict=True):
        if factor.motion is Motion.SHIFT:
            position = [(p + c * amount.number) % PRIME for p, c in zip(position, columns[factor.axis], strict=True)]
            continue
        angle = amount if factor.motion is Motion.TURN else amount * half_a_turn
        columns = _turned(columns, factor.axis, trial.angles.pair(angle))
    rows = [columns[k][i] for i in range(3) for k in range(3)]
    return {name: Value(number) for name, number in zip(_POSE, (*position, *rows), strict=True)}


def _turned(columns: Columns, axis: int, pair: Pair) -> Columns:
    """The columns of a rotation, behind it a turn about one of its axes."""
    (cosine, sine), first, second = pair, (axis + 1) % 3, (axis + 2) % 3
    one, other, found = columns[first], columns[second], list(columns)
    found[first] = [(cosine * a + sine * b) % PRIME for a, b in zip(one, other, strict=True)]
    found[second] = [(cosine * b - sine * a) % PRIME for a, b in zip(one, other, strict=True)]
    return found


def check_exactly(kin: Kinematics, described: Mechanism) -> Exact:
    """Forward and inverse kinematics meet the equations exactly at random machines and poses, or it cannot be asked.
    Raises `Disagreement` if one does not.

    The form of a machine with oblique frames holds numbers that were computed, and rounded: where the equations of the
    description do not hold to the last digit, those of the form do.
    """
    if kin.mechanism.search is not None:
        return Exact(0, "its roots are searched along a joint")
    if described.nominal is not None:
        return Exact(0, "with deviations, the inverse ends in steps on the closure")
    if kin.mechanism.drives:
        return Exact(0, "loops move joints of its chain")
    described = as_fractions(with_exact_angles(as_in(kin.mechanism, described)))
    try:
        return _checked(kin, described)
    except Disagreement:
        if not is_rounded(kin.mechanism, described):
            raise
    try:
        exact = _checked(kin, kin.mechanism)
    except Disagreement:
        return Exact(0, _ROUNDED)
    return replace(exact, but=_ROUNDED, what="equations of the machine's form") if exact.trials else exact


def _checked(kin: Kinematics, described: Mechanism) -> Exact:
    """The check against the equations of a mechanism. Raises `Disagreement`."""
    rng, found, multiple, steps = Random(20260), 0, 1, iter(range(_STEPS))
    for _ in steps:
        try:
            trial = drawn(kin, described, rng, multiple, steps)
            _check_forward(trial)
            _check_inverse(trial)
        except NoRoot:
            continue
        except Fractional as problem:
            multiple *= problem.denominator
            if multiple > _LARGEST:
                return Exact(0, "its axes turn by fractions of each other")
            continue
        except NotAlgebraic as problem:
            return Exact(0, str(problem))
        found += 1
        if found == TRIALS:
            break
    if not found:
        return Exact(0, "too few random numbers have all the roots that it takes")
    if described.is_platform:
        return Exact(found, "forward kinematics iterates", "equations of the inverse")
    return Exact(found)


def drawn(kin: Kinematics, described: Mechanism, rng: Random, multiple: int, steps: Iterator[int]) -> Trial:
    """A random machine with a random pose. multiple: that of an angle that every axis value is."""
    degree = Value(_any(rng), {("", 1): Fraction(1)})
    angles = Angles(degree.number)

    def angle(name: str) -> Value:
        whole = angles.planted(name, on_circle(_any(rng)), _any(rng)) * fraction(Fraction(multiple))
        angles.know(whole)
        return whole * degree.inverted()

    inputs: Known = {p.name: ZERO if p.name in kin.limit_inputs else _parameter(p, rng, angle) for p in kin.parameters}
    named = {p.given_name: p.name for p in kin.mechanism.parameters}
    numbers = {p.symbol: evaluated([p.fixed], {}, angles, degree)[0] for p in described.parameters if p.fixed}
    given = [p for p in described.parameters if p.symbol not in numbers]
    own = numbers | {p.symbol: _as_number(inputs[named[p.given_name]]) for p in given}
    axes = {j.axis.name: angle(j.axis.name) if j.in_degrees else Value(_any(rng)) for j in described.joints}
    trial = Trial(kin, described, angles, degree, inputs, own, axes, {}, steps)
    _know(trial)
    if described.chain is not None:
        trial.pose = frame_of(trial, trial.joints(axes))
    elif described.is_platform:
        trial.pose = _any_pose(trial, rng)
    return trial


def _know(trial: Trial) -> None:
    """Take the planted values for all angles that equal them: a pitch and a gear read their turns."""
    joints = trial.joints(trial.axes)
    turned = {j.symbol for j in trial.described.joints}
    if trial.described.chain is not None:
        stated = [f.amount for f in trial.described.chain.factors if f.motion is Motion.TURN]
    else:
        stated = [f.args[0] for e in trial.described.equations for f in sp.sympify(e).atoms(sp.sin, sp.cos)]
    moving = sorted((a for a in {*stated, *turned} if a.free_symbols & turned), key=sp.default_sort_key)
    moved = evaluated(moving, joints, trial.angles, trial.degree, trial.own)
    for angle in (*moved, *trial.machine_joints().values()):
        if angle.form is not None:
            trial.angles.know(angle)


def _as_number(value: Value | bool) -> Value:
    return value if isinstance(value, Value) else fraction(Fraction(bool(value)))


def _any(rng: Random) -> int:
    return rng.randrange(2, PRIME)


def _parameter(parameter: Parameter, rng: Random, angle: Callable[[str], Value]) -> Value | bool:
    """A random value of an input; settings as they are by default."""
    if parameter.role is Role.FLAG:
        return bool(rng.getrandbits(1)) if parameter.default is None else bool(parameter.default)
    if parameter.role is Role.SIGN:
        return fraction(Fraction(rng.choice((-1, 1))))
    if parameter.role in _RATIOS and parameter.name not in _SETTINGS:
        return fraction(Fraction(rng.choice((-3, -2, -1, 1, 2, 3)), rng.choice((1, 2))))
    if parameter.name in _SETTINGS:
        return fraction(Fraction(repr(float(parameter.nominal))))
    return angle(parameter.name) if parameter.unit == "deg" else Value(_any(rng))


def _any_pose(trial: Trial, rng: Random) -> dict[str, Value]:
    """A random pose of a platform, as far as it moves."""
    if trial.kin.mechanism.passive:
        raise NotAlgebraic("the loop decides what the task does not command")
    pose = {c: Value(_any(rng)) if c in trial.described.task.position else ZERO for c in _POSE[:3]}
    columns = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    for axis in (2,) if trial.described.task.turning is Turning.ABOUT_Z else (2, 1, 0):
        columns = _turned(columns, axis, on_circle(_any(rng)))
    return pose | {r.name: Value(columns[k % 3][k // 3]) for k, r in enumerate(ROTATION_ENTRIES)}


def _runs(trial: Trial, program_name: str, given: Mapping[str, Value], accept: Callable[[Run], bool]) -> None:
    """Run a program with every sign of its roots until the answer is accepted; raises `Disagreement` where none is, and
    `NoRoot` where no steps are left.
    """
    program = getattr(trial.kin, program_name)
    signs: Signs | None = Signs()
    for _ in trial.steps:
        assert signs is not None
        with suppress(NotPlanted):
            if accept(_begun(trial, program, given, signs)):
                return
        signs = signs.others()
        if signs is None:
            raise Disagreement(
                f"{program_name} kinematics does not meet the closure exactly, whatever signs roots have"
            )
    raise NoRoot


def _begun(trial: Trial, program: Program, given: Mapping[str, Value], signs: Signs) -> Run:
    """A run of a program: constants of the machine are computed when they are read."""
    setup = Run(trial.kin.setup, dict(trial.inputs), trial.angles, signs, trial.degree)
    constants = {o.name for o in trial.kin.setup.outputs}

    def input_of(name: str) -> Value | bool:
        if name in constants:
            return setup.output(name)
        return fraction(Fraction(signs.next())) if name.startswith("sigma_") else ZERO  # no turn is commanded

    return Run(program, dict(given), trial.angles, signs, trial.degree, input_of)


def _check_forward(trial: Trial) -> None:
    if trial.described.is_platform:
        return

    def is_right(run: Run) -> bool:
        pose = {name: run.output(name) for name in _POSE}
        if trial.described.chain is not None:
            return all(pose[n].number == trial.pose[n].number for n in _POSE)
        trial.pose = pose
        _fit_surplus(trial)
        return not any(trial.equations(trial.axes, pose))

    _runs(trial, "forward", trial.axes, is_right)


def _fit_surplus(trial: Trial) -> None:
    """Give the axes of surplus rods, which nothing planted, the lengths that they have at the pose."""
    for joint, rod in zip(trial.described.surplus_joints, trial.described.surplus_rods, strict=True):

        def at(value: Value, wanted: sp.Expr, axis: str = joint.axis.name) -> Value:
            joints = trial.joints({**trial.axes, axis: value})
            return evaluated([wanted], {**joints, **trial.pose}, trial.angles, trial.degree, trial.own)[0]

        zero = at(ZERO, rod.length)
        away = Value(root(at(ZERO, rod.equation + rod.length**2).number)) + -zero
        trial.axes[joint.axis.name] = away * (at(ONE, rod.length) + -zero).inverted()


def _check_inverse(trial: Trial) -> None:
    joints = trial.described.joints
    references = {j.reference.name: trial.axes[j.axis.name] for j in joints}

    def is_right(run: Run) -> bool:
        axes: dict[str, Value] = {}
        for joint in joints:
            axes[joint.axis.name] = run.output(joint.axis.name)
            if not trial.described.is_platform and not _same(trial, joint, axes[joint.axis.name]):
                return False
        return not any(trial.equations(axes, trial.pose))

    _runs(trial, "branch", trial.pose | references, is_right)


def _same(trial: Trial, joint: Joint, value: Value) -> bool:
    """Whether an axis value is the planted one, but for whole turns."""
    planted = trial.axes[joint.axis.name]
    if not joint.in_degrees or value.form is None or value.number == planted.number:
        return value.number == planted.number
    return trial.angles.pair(value * trial.degree) == trial.angles.pair(planted * trial.degree)
