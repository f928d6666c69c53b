"""The description of a machine in its module, as plain data: axes, parameters, configuration, limits, margins."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count
from typing import Any

from derive.description.mechanism import Joint, Mechanism, Parameter
from derive.emit.inputs import Inputs, Spelling, inputs_of, word_of
from derive.kept import kept_by_identity
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import CHECK_LIMITS, WARNING_DISTANCE

_TURN = 360.0


@kept_by_identity(10)
def inputs(kinematics: Kinematics) -> Inputs:
    """The names of the parameters: they are members of an object, which may have any name."""
    return inputs_of(kinematics, _JAVASCRIPT, {})


def _meaning(name: str) -> str | None:
    return "what an object inherits from" if name == "__proto__" else None


def _others(parameter: Parameter, wish: str) -> Iterator[str]:
    plain = f"{wish.strip('_')}_{word_of(parameter)}"
    yield plain
    yield from (f"{plain}_{number}" for number in count(2))


_JAVASCRIPT = Spelling(lambda parameter: parameter.given_name, _others, _meaning)


def description(kin: Kinematics, module: str) -> dict[str, Any]:
    """The data."""
    mechanism, given = kin.mechanism, inputs(kin)
    names = given.names
    order = [joint.name for joint in mechanism.joints]
    held = {joint.name for joint in mechanism.held_joints}
    return {
        "name": mechanism.name,
        "block": mechanism.block_name,
        "module": module,
        "summary": mechanism.summary,
        "source": mechanism.source,
        "role": _role(mechanism),
        "task": {"position": mechanism.task.position, "turning": mechanism.task.turning.value},
        "freedom": kin.freedom.value,
        "readsRotation": kin.reads_rotation,
        "startsForward": kin.starts,
        "axes": [_axis(joint, joint.name in held) for joint in mechanism.joints],
        "parameters": [_parameter(p, names[p.name]) for p in kin.parameters],
        "settings": {"checkLimits": names[CHECK_LIMITS], "warningDistance": names[WARNING_DISTANCE]},
        "assembly": mechanism.assembly and names[mechanism.assembly.parameter],
        "limits": _limits(mechanism, names),
        "configuration": _configuration(kin),
        "defaultConfiguration": [1] * len(kin.branches) + [0] * len(kin.period_joints),
        "branchCount": len(kin.branches),
        "periodAxes": [order.index(joint.name) for joint in kin.period_joints],
        "distanceAxes": [order.index(joint.name) for joint in kin.distance_joints],
        "sides": kin.tried_branches,
        "jacobianRows": list(kin.rows),
        "margins": [{"name": m.name, "kind": m.kind, "isDistance": bool(m.length)} for m in kin.margins],
        "notes": [*map(given.reworded, mechanism.all_notes), *given.notes],
    }


def _role(mechanism: Mechanism) -> str:
    return "position" if mechanism.is_position else "orientation" if mechanism.is_orientation else "complete"


def _axis(joint: Joint, is_held: bool) -> dict[str, Any]:
    """An axis; its period where a full turn of the axis leads to the same pose."""
    is_periodic = joint.is_angle and joint.pitch == 0 and joint.coupling == 0 and not joint.is_geared
    return {
        "name": joint.name,
        "kind": joint.kind.value,
        "unit": "deg" if joint.in_degrees else "u",
        "meaning": joint.meaning,
        "multiTurn": joint.multi_turn,
        "period": _TURN if is_periodic else None,
        "isHeld": is_held,
        "nominal": joint.shown,
    }


def _parameter(p: Parameter, name: str) -> dict[str, Any]:
    return {
        "name": name,
        "kind": p.role.value,
        "unit": p.unit,
        "meaning": p.meaning,
        "low": p.low,
        "high": p.high,
        "lowIsOpen": p.low_open,
        "default": p.default,
        "nominal": p.nominal,
    }


def _limits(mechanism: Mechanism, names: Mapping[str, str]) -> list[dict[str, Any]]:
    """The axes, then the other quantities that have limits; `lower` and `upper` are parameters."""
    found = [(j.name, j.key, "deg" if j.in_degrees else "u", True) for j in mechanism.joints]
    found += [(q.name, q.name, "deg" if q.is_angle else "u", False) for q in mechanism.limited]
    return [
        {"name": name, "key": key, "unit": unit, "isAxis": is_axis,
         "lower": names[f"lower_{key}"], "upper": names[f"upper_{key}"]}
        for name, key, unit, is_axis in found
    ]  # fmt: skip


def _configuration(kin: Kinematics) -> list[dict[str, Any]]:
    """The bytes: branches first, then the turns of axes."""
    branches = [{"name": b.name, "kind": "branch", "branches": list(b.names), "default": 1} for b in kin.branches]
    turns = [{"name": j.name, "kind": "period", "branches": [], "default": 0} for j in kin.period_joints]
    return [*branches, *turns]
