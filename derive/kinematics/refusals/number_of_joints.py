"""The inverse solves for as many joints as the task commands quantities: any other number is refused at the start."""

from __future__ import annotations

import sympy as sp

from derive.description.mechanism import DescriptionError, Mechanism, Turning
from derive.equations.chain_splits import is_spatial
from derive.equations.pitch.chain import followed_of
from derive.kinematics.differential import jacobian_rows


def check_joints(mechanism: Mechanism) -> None:
    """Refuse more conditions than joints or coordinates: they cannot be met, and no later step would notice."""
    if mechanism.followed_turns:
        followed_of(mechanism)
    rows = jacobian_rows(mechanism)
    equations = len(mechanism.equations) + (mechanism.heading is not None)
    commanded = f"{len(rows)} quantities ({', '.join(rows)})"
    spare = len(mechanism.solved_joints) - len(rows)
    if spare:
        raise DescriptionError(_wrong_number(mechanism, spare, commanded))
    if mechanism.is_platform:  # conditions without joints fix coordinates that are not commanded: see `check_home`
        joints = {j.symbol for j in mechanism.joints}
        equations = sum(bool(sp.sympify(e).free_symbols & joints) for e in mechanism.equations)
    if equations > len(rows):
        raise DescriptionError(f"the closure has {equations} equations, and the task commands only {commanded}")


def _wrong_number(mechanism: Mechanism, spare: int, commanded: str) -> str:
    """The message for a machine with more or fewer joints than commanded quantities."""
    joints, held = mechanism.joints, mechanism.held
    if spare < 0:
        left = f", of which {len(held)} {'is' if len(held) == 1 else 'are'} held" if held else ""
        less = "command less of the pose" + (", and hold the rest by guides=" if mechanism.is_platform else "")
        remedy = _follow_pitch(mechanism, spare) or f"; {less}, or add joints"
        return f"the task commands {commanded}, and there are only {len(joints)} joints{left}{remedy}"
    number = "one joint" if spare == 1 else f"{spare} joints"
    names = "the one that is" if spare == 1 else "those that are"
    remedy = f"name {names} held at the reference: held=({joints[0].name},)"
    if mechanism.chain is None:  # in a closed loop every joint follows from the pose
        remedy = "command more of the pose, or leave out joints"
    return (
        f"{number} too many: the task commands {commanded}, and {len(mechanism.solved_joints)} joints are to be solved "
        f"for; {remedy}"
    )


def _follow_pitch(mechanism: Mechanism, spare: int) -> str:
    """The advice on what to command instead, for a chain whose heading may follow from its position."""
    instead = {(Turning.DIRECTION, -1): Turning.PITCH, (Turning.FULL, -1): Turning.PITCH_ROLL}
    found = instead.get((mechanism.task.turning, spare))
    if found is None or mechanism.chain is None or mechanism.task.position != "xyz" or not is_spatial(mechanism.chain):
        return ""
    return f"; where the position decides the heading of the tool, command its {found.value}: Turning.{found.name}"
