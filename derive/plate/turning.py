"""A loop that turns its platform: forward kinematics by iteration, its joints at the home pose, and sampled poses.

Forward kinematics starts at the home pose, and the assembly mode is the one of that pose: the sign of det A there. It
depends on the branches as well, so parameters state the branches at home: `home_elbow_1_left` is a flag, and the
derivation of the inverse is evaluated at the home pose with these signs.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from derive.description.mechanism import DescriptionError, Mechanism, Turning
from derive.equations.axes import Forward, axis_lets, joint_lets, reference_value
from derive.equations.closures.fixed_names import fixed_lets
from derive.ir.interpret import evaluate, run
from derive.ir.passes import normalise, renamed
from derive.ir.program import Let, Output, Require, Statement, Status, rewritten
from derive.ir.reason import about_parameters
from derive.ir.symbols import HEADING, POSITION, ROTATION_ENTRIES, SCALE, Flag, cosine, is_count, real, sine
from derive.plate.legs import angles, by_angles, is_driven, position_of, rotation_of
from derive.plate.newton import at_given, found_from
from derive.plate.passive import mode_constants, modes_at_home
from derive.plate.plate import platform_size, pose_at_home

Samples = dict[str, NDArray[np.float64]]

_REACHED = "a home pose within reach"
_AROUND, _TURNED = 0.1, 0.2
"""The largest distance of sampled poses from home, in characteristic lengths and radians."""
_SAMPLES = 256


class NoPoseAtHome(DescriptionError):
    """No pose near the home pose of a loop is possible."""


def forward_from_start(mechanism: Mechanism) -> Forward:
    """The pose at axis values, by iteration from the start: the home pose, unless a caller gives another one."""
    return found_from(mechanism, at_given(mechanism))


def given_pose(mechanism: Mechanism) -> Forward:
    """A pose that is known together with the axis values: no iteration is needed."""
    return Forward(joint_lets(mechanism), position_of(mechanism), tuple(rotation_of(mechanism)))


def joints_at_home(mechanism: Mechanism, statements: Sequence[Statement]) -> tuple[Statement, ...]:
    """The statements that bind the joints at the home pose, each name with `home_` before it; none if no joint moves
    an end of a rod.

    statements: those of the inverse, in the signs of branches.
    """
    if not is_driven(mechanism, [v for rod in mechanism.rods for v in rod.base]):
        return ()
    signs = [Let(real(f"sign_{b.name}"), 1 - 2 * real(b.home_flag)) for b in mechanism.branches]
    own = [s for s in statements if not (isinstance(s, Let) and s.name in {sign.name for sign in signs})]
    wanted = [s for j in mechanism.joints for s in ((cosine(j.symbol), sine(j.symbol)) if j.is_angle else (j.symbol,))]
    program = normalise("home", (*signs, *fixed_lets(mechanism), *own), [Output(s.name, s) for s in wanted])
    bound = {s: real(f"home_{s.name}") for s in program.bound()}
    pose = dict(zip(map(real, mechanism.motion.position), mechanism.home, strict=False))
    pose |= {reference_value(j): sp.Integer(0) for j in mechanism.joints}
    if mechanism.motion.turning is Turning.FULL:
        pose |= {r: real(f"home_{r.name}") for r in ROTATION_ENTRIES}
    else:
        pose |= {cosine(HEADING): real("cos_home_heading"), sine(HEADING): real("sin_home_heading")}
    table = {**pose, **bound}
    named = [Let(real(f"home_{o.name}"), o.value.xreplace(table)) for o in program.outputs if real(o.name) not in bound]
    return (*(_at_home(s, table) for s in program.body), *named)


def _at_home(statement: Statement, table: dict[sp.Symbol, sp.Expr]) -> Statement:
    known = rewritten(statement, lambda e: e.xreplace(table))
    if isinstance(known, Require):
        return Require(known.condition, Status.NOT_INITIALIZED, reason=about_parameters(_REACHED))
    return renamed(known, lambda name: real(f"home_{name.name}"))


def samples_near_home(
    mechanism: Mechanism, derivation: Sequence[Statement], signs: Sequence[sp.Symbol], machine: Samples, seed: int
) -> Samples:
    """Poses near the home of a machine, and the axes there in every branch, from the derivation of the inverse.

    signs: the signs of its steps. Raises `NoPoseAtHome` if none of the poses is possible.
    """
    known = (*platform_size(mechanism), *modes_at_home(mechanism, pose_at_home(mechanism)))
    sizes = [Output(SCALE.name, SCALE), *mode_constants(mechanism)]
    machine = {**machine, **run(normalise("size", known, sizes), machine)[0]}
    rng = np.random.default_rng(seed)
    poses = poses_around_home(mechanism, machine, rng, (_AROUND, _TURNED), _SAMPLES)
    axes = [Let(let.name, let.value) for j in mechanism.joints for let in axis_lets(j)]
    own = {s.name for s in derivation if isinstance(s, Let)}
    statements = (*derivation, *(let for let in axes if let.name not in own))
    passive = [real(c) for c in mechanism.passive if c != "twist"]
    passive += ROTATION_ENTRIES if "twist" in mechanism.passive else []
    wanted = [*(j.axis for j in mechanism.joints), *passive]
    program = normalise("joints", statements, [Output(s.name, s) for s in wanted])
    values = {**machine, **poses}
    values |= {sign.name: rng.choice([-1.0, 1.0], _SAMPLES) for sign in signs}
    values |= {f"commanded_{r.name}": poses[r.name] for r in ROTATION_ENTRIES if mechanism.passive}
    rest = {s.name: _nothing(s) for s in program.inputs if s.name not in values}
    found, status = run(program, values | rest)
    good = np.broadcast_to(status == Status.OK, (_SAMPLES,))
    if not good.any():
        raise NoPoseAtHome("no pose near the home pose is possible: is it where the legs reach it?")
    columns = {n: np.broadcast_to(v, (_SAMPLES,))[good] for n, v in (poses | found).items()}
    return {**machine, **columns, **{j.reference.name: columns[j.axis.name] for j in mechanism.joints}}


def poses_around_home(
    mechanism: Mechanism, machine: Samples, rng: np.random.Generator, within: tuple[float, float], count: int
) -> Samples:
    """Poses around home, by the names that programs read. within: the largest distance from home, in characteristic
    lengths and radians.
    """
    width, reach = len(mechanism.motion.position), float(machine[SCALE.name])
    home = [float(evaluate(v, machine)) for v in mechanism.home]
    sizes = np.array([within[0] * reach if k < width else within[1] for k in range(len(home))])
    drawn = np.array(home) + sizes * rng.uniform(-1.0, 1.0, (count, len(home)))
    values: Samples = {c.name: np.zeros(count) for c in POSITION}
    values |= {c: drawn[:, k] for k, c in enumerate(mechanism.motion.position)}
    turns = dict(zip(angles(mechanism), drawn[:, width:].T, strict=True))
    named = {f"{w}_{a}": f(v) for a, v in turns.items() for w, f in (("cos", np.cos), ("sin", np.sin))}
    matrix = by_angles(angles(mechanism))
    for name, entry in zip(ROTATION_ENTRIES, matrix, strict=True):
        values[name.name] = np.broadcast_to(evaluate(entry, named), (count,))
    if len(turns) == 1:
        values |= {cosine(HEADING).name: values["r11"], sine(HEADING).name: values["r21"]}
    return values


def _nothing(symbol: sp.Symbol) -> np.ndarray:
    """The zero that every limit, commanded turn and reference gets."""
    return np.asarray(False if isinstance(symbol, Flag) else 0 if is_count(symbol) else 0.0)
