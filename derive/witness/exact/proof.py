"""Random machines and poses in the field, and the equations that must hold there."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from random import Random

import sympy as sp

from derive.description.amounts import number_in, with_right_angles
from derive.description.mechanism import Joint, Mechanism, Parameter, Role, Turning
from derive.geometry.frames import Motion
from derive.ir.program import Program
from derive.ir.symbols import MIN_TYPE2_MARGIN, ROTATION_ENTRIES
from derive.kinematics.kinematics import Exact, Kinematics
from derive.witness.disagreement import Disagreement
from derive.witness.exact.field import PRIME, NoRoot, Pair, on_circle
from derive.witness.exact.runs import Known, Run, Signs, evaluated
from derive.witness.exact.values import ZERO, Angles, Fractional, NotAlgebraic, NotPlanted, Value, fraction

TRIALS = 3
_DRAWS = 4000
"""Draws, most of which end at the first number without a root."""
_LARGEST = 10**9
"""The largest multiple of which angles are drawn."""
_TRIED = 4096
"""Signs of roots that are tried for one pose."""
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
    own: dict[str, Value]
    """The parameters, by the symbols of the description."""
    axes: dict[str, Value]
    """The planted axis values."""
    pose: dict[str, Value]

    def joints(self, axes: Mapping[str, Value]) -> dict[str, Value]:
        """The joint values of the description."""
        return self._joints(self.described, axes, self.own)

    def machine_values(self) -> dict[str, Value]:
        """The values of the machine's own symbols, whose joints may have other gears: nothing is measured by them."""
        fixed = [p for p in self.kin.mechanism.parameters if p.fixed is not None]
        known = {name: _as_number(value) for name, value in self.inputs.items()}
        known |= {p.name: evaluated([p.fixed], {}, self.angles, self.degree)[0] for p in fixed}
        return known | self._joints(self.kin.mechanism, self.axes, known)

    def _joints(self, of: Mechanism, axes: Mapping[str, Value], known: Mapping[str, Value]) -> dict[str, Value]:
        motors: dict[str, Value] = {}
        for joint in of.joints:
            offset = self.inputs[joint.offset.name]
            assert isinstance(offset, Value)
            motor = axes[joint.axis.name] + -offset
            motors[joint.motor.name] = motor * self.degree if joint.in_degrees else motor
        expressions = [j.motor * j.ratio + j.coupling for j in of.joints]
        values = evaluated(expressions, {**known, **motors}, self.angles, self.degree)
        return {j.symbol.name: v for j, v in zip(of.joints, values, strict=True)}

    def equations(self, axes: Mapping[str, Value], pose: Mapping[str, Value]) -> list[int]:
        """The closure of the description: zeros where it holds."""
        joints = self.joints(axes)
        if self.described.chain is not None:
            frame = self.frame(self.described, {**self.own, **joints})
            return [(frame[n].number - pose[n].number) % PRIME for n in self.commanded()]
        stated = [sp.sympify(e) for e in self.described.equations]
        if self.described.heading is not None:
            heading = self.described.heading
            stated += [sp.cos(heading) - ROTATION_ENTRIES[0], sp.sin(heading) - ROTATION_ENTRIES[3]]
        values = evaluated(stated, {**self.own, **joints, **pose}, self.angles, self.degree)
        return [v.number for v in values]

    def frame(self, of: Mechanism, known: Mapping[str, Value]) -> dict[str, Value]:
        """The frame at the end of a chain, multiplied out factor by factor."""
        assert of.chain is not None
        amounts = evaluated([f.amount for f in of.chain.factors], known, self.angles, self.degree)
        position, columns = [0, 0, 0], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        half_a_turn = self.degree * fraction(Fraction(180))
        for factor, amount in zip(of.chain.factors, amounts, strict=True):
            if factor.motion is Motion.SHIFT:
                column = columns[factor.axis]
                position = [(p + c * amount.number) % PRIME for p, c in zip(position, column, strict=True)]
                continue
            angle = amount if factor.motion is Motion.TURN else amount * half_a_turn
            columns = _turned(columns, factor.axis, self.angles.pair(angle))
        rows = [columns[k][i] for i in range(3) for k in range(3)]
        return {name: Value(number) for name, number in zip(_POSE, (*position, *rows), strict=True)}

    def is_rounded(self) -> bool:
        """Whether the machine has decimals in place of oblique numbers of the description: coordinates between oblique
        axes, and their angles. It is then not the same machine but for rounding, which is measured in real numbers.
        """
        return _is_oblique(self.described) and self.frame(self.kin.mechanism, self.machine_values()) != self.pose

    def commanded(self) -> tuple[str, ...]:
        """The entries of the pose that a chain must meet."""
        turning = self.described.task.turning
        if turning is Turning.NONE:
            return tuple(self.described.task.position)
        column = ("r13", "r23", "r33")
        is_column = turning in (Turning.DIRECTION, Turning.PITCH)
        return (*self.described.task.position, *(column if is_column else _POSE[3:]))


def _turned(columns: Columns, axis: int, pair: Pair) -> Columns:
    """The columns of a rotation, behind it a turn about one of its axes."""
    (cosine, sine), first, second = pair, (axis + 1) % 3, (axis + 2) % 3
    one, other, found = columns[first], columns[second], list(columns)
    found[first] = [(cosine * a + sine * b) % PRIME for a, b in zip(one, other, strict=True)]
    found[second] = [(cosine * b - sine * a) % PRIME for a, b in zip(one, other, strict=True)]
    return found


def check_exactly(kin: Kinematics, described: Mechanism) -> Exact:
    """Forward and inverse kinematics meet the equations exactly at random machines and poses, or it cannot be asked.
    Raises `Disagreement` where one does not.
    """
    if kin.mechanism.search is not None:
        return Exact(0, "its roots are searched along a joint")
    described, rng, found, multiple = with_right_angles(described), Random(20260), 0, 1
    for _ in range(_DRAWS):
        try:
            trial = drawn(kin, described, rng, multiple)
            if trial.is_rounded():
                return Exact(0, "between its oblique axes are decimal numbers that the description does not hold")
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
            return Exact(found, "forward kinematics iterates" if described.is_platform else "")
    return Exact(0, "too few random numbers have all the roots that it takes")


def _is_oblique(described: Mechanism) -> bool:
    """Whether a chain has a fixed turn that is no right angle, or a number in a shift that is no fraction."""
    for factor in described.chain.factors if described.chain is not None else ():
        if factor.motion is Motion.TURN and not (2 * number_in(factor.amount) / sp.pi).is_Integer:
            return True
        odd = sp.sympify(factor.amount).atoms(sp.Function, sp.Pow) if factor.motion is Motion.SHIFT else ()
        if any(a.is_number and a.as_base_exp()[0] != sp.pi for a in odd):
            return True
    return False


def drawn(kin: Kinematics, described: Mechanism, rng: Random, multiple: int) -> Trial:
    """A random machine with a random pose. multiple: that of an angle that every axis value is."""
    angles = Angles()
    degree = Value(_any(rng), {("", 1): Fraction(1)})

    def angle(name: str) -> Value:
        whole = angles.planted(name, on_circle(_any(rng)), _any(rng)) * fraction(Fraction(multiple))
        angles.know(whole)
        return whole * degree.inverted()

    inputs: Known = {p.name: ZERO if p.name in kin.limit_inputs else _parameter(p, rng, angle) for p in kin.parameters}
    named = {p.given_name: p.name for p in kin.mechanism.parameters}
    numbers = {p.symbol.name: evaluated([p.fixed], {}, angles, degree)[0] for p in described.parameters if p.fixed}
    given = [p for p in described.parameters if p.symbol.name not in numbers]
    own = numbers | {p.symbol.name: _as_number(inputs[named[p.given_name]]) for p in given}
    axes = {j.axis.name: angle(j.axis.name) if j.in_degrees else Value(_any(rng)) for j in described.joints}
    trial = Trial(kin, described, angles, degree, inputs, own, axes, {})
    _know(trial)
    if described.chain is not None:
        trial.pose = trial.frame(described, {**own, **trial.joints(axes)})
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
    told = evaluated(moving, {**trial.own, **joints}, trial.angles, trial.degree)
    told += [trial.machine_values()[j.symbol.name] for j in trial.kin.mechanism.joints]
    for angle in told:
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
    """Run a program with every sign of its roots until the answer is accepted; raises `Disagreement` where none is."""
    program = getattr(trial.kin, program_name)
    signs: Signs | None = Signs()
    for _ in range(_TRIED):
        assert signs is not None
        with suppress(NotPlanted):
            if accept(_begun(trial, program, given, signs)):
                return
        signs = signs.others()
        if signs is None:
            raise Disagreement(
                f"{program_name} kinematics does not meet the closure exactly, whatever signs roots have"
            )
    raise NotAlgebraic("it takes too many roots, each with two signs")


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
        return not any(trial.equations(trial.axes, pose))

    _runs(trial, "forward", trial.axes, is_right)


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
