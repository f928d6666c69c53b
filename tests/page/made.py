"""The pages of the catalogue, each made once, and poses of its machines with the values of all names on them."""

from functools import cache
from xml.etree import ElementTree as ET

import numpy as np

from derive.emit.page.names import Spelling, spelling_of
from derive.emit.page.page import Page, page_of
from derive.ir.interpret import run
from derive.ir.program import Status
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.sampling import sample_axes, sample_machine
from derive.report.reference_calls import FRAME, Machine, machine_with
from tests.mechanisms import catalogue, kinematics_of, named
from tests.orthonormal import about
from tests.page.reading import Values, parsed

NAMES = tuple(mechanism.name for _, mechanism in catalogue())
_DRAWN, _POSES = 800, 12
_CLEAR = 0.02


@cache
def page(name: str) -> Page:
    """The page of a mechanism of the catalogue, without pictures."""
    mechanism = named(name)
    return page_of(mechanism, kinematics_of(mechanism), has_pictures=False)


@cache
def tree(name: str) -> ET.Element:
    return parsed(page(name).text)


@cache
def spelling(name: str) -> Spelling:
    return spelling_of(kinematics_of(named(name)))


@cache
def machine(name: str) -> Machine:
    """A machine that is not the nominal one, with offsets; of a platform the nominal one: it reaches its home."""
    kinematics = kinematics_of(named(name))
    own = kinematics.mechanism
    if own.is_platform:
        return machine_with(kinematics, {p.name: p.nominal for p in kinematics.parameters})
    given = {p.name: float(sample_machine(own, 41)[p.name]) for p in kinematics.parameters}
    given |= {j.offset.name: 3.0 + k for k, j in enumerate(own.joints)}
    found = machine_with(kinematics, given)
    assert found.status is Status.OK, name
    return found


@cache
def samples(name: str) -> dict[str, np.ndarray]:
    """By neutral names: the constants of the machine, axis values, frames, references and signs of regular poses."""
    kinematics, made = kinematics_of(named(name)), machine(name)
    axes = _axes(kinematics, made)
    found, status = run(kinematics.forward, {**made.values, **axes})
    good = np.asarray(np.broadcast_to(status == Status.OK, (_DRAWN,)), dtype=bool)
    signs = {b.name: np.broadcast_to(found[f"branch_{b.name}"], (_DRAWN,)) for b in kinematics.branches}
    for margin in signs.values():
        good = good & (np.abs(margin) > _CLEAR * np.max(np.abs(margin[good]), initial=0.0))
    given = {**made.values, **axes, **{n: np.broadcast_to(found[n], (_DRAWN,)) for n in FRAME}}
    given |= {j.reference.name: axes[j.axis.name] for j in kinematics.mechanism.joints}
    given |= {j.turn.name: np.zeros(_DRAWN) for j in kinematics.mechanism.joints}
    given |= {f"sigma_{n}": np.sign(v) for n, v in signs.items()}
    if kinematics.search_given is None:  # which would search at every pose
        _, solved = run(kinematics.branch, given)
        good = good & np.asarray(np.broadcast_to(solved == Status.OK, (_DRAWN,)), dtype=bool)
    rows = np.flatnonzero(good)[:_POSES]
    assert len(rows) >= 3, f"{name}: {len(rows)} poses"
    values = {n: v[rows] for n, v in axes.items()}
    values |= {n: np.broadcast_to(found[n], (_DRAWN,))[rows] for n in FRAME}
    for joint in kinematics.mechanism.joints:
        values[joint.reference.name] = values[joint.axis.name] + 2.0 * (joint not in kinematics.mechanism.held_joints)
        values[joint.turn.name] = np.zeros(len(rows))
    values |= {f"sigma_{n}": np.sign(v[rows]) for n, v in signs.items()}
    if "twist" in kinematics.mechanism.passive:  # commanded is the same direction of the tool, with another twist
        turned = np.stack([values[n] for n in FRAME[3:]], axis=1).reshape(-1, 3, 3) @ about(2, 25.0)
        values |= {f"commanded_{n}": turned[:, k // 3, k % 3] for k, n in enumerate(FRAME[3:])}
    return {**made.values, **values}


def _axes(kinematics: Kinematics, made: Machine) -> dict[str, np.ndarray]:
    joints = kinematics.mechanism.joints
    if not kinematics.mechanism.is_platform:
        drawn = sample_axes(kinematics.mechanism, dict(made.values), _DRAWN, 17)
        return {j.axis.name: drawn[j.axis.name] + made.given[j.offset.name] for j in joints}
    spread = np.random.default_rng(2).uniform(-1.0, 1.0, (_DRAWN, len(joints)))
    size = [4.0 if j.in_degrees else 20.0 for j in joints]
    return {j.axis.name: made.home[k] + size[k] * spread[:, k] for k, j in enumerate(joints)}


def spelled(name: str, values: Values) -> dict[str, np.ndarray]:
    """Values by the names on the page."""
    spell = spelling(name)
    return {spell(neutral): np.asarray(value) for neutral, value in values.items()}
