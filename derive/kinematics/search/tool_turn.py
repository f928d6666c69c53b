"""A tool whose direction is commanded, and not its turn about its own line: this turn is a further joint of the arm,
which no motor makes. The arm follows the whole pose then, whatever the commanded turn is.
"""

from __future__ import annotations

from dataclasses import replace

from derive.description.joints import Joint, Kind
from derive.description.mechanism import Mechanism, Task, Turning
from derive.form.chain import with_normal_chain
from derive.geometry.frames import Chain, Rz
from derive.ir.symbols import COORDINATE_NAMES, real

TOOL_TURN = Joint(real("turn_of_tool"), "turn_of_tool", Kind.ROTARY, "the turn of the tool about its line", free=True)
_EVERYWHERE = "".join(COORDINATE_NAMES)


def with_tool_turn(mechanism: Mechanism) -> Mechanism:
    """The arm with the turn of the tool as its last joint, where position and direction are commanded."""
    chain, task = mechanism.chain, mechanism.task
    if chain is None or task != Task(_EVERYWHERE, Turning.DIRECTION):
        return mechanism
    turned = replace(
        mechanism,
        joints=(*mechanism.joints, TOOL_TURN),
        chain=Chain((*chain.factors, *Rz(TOOL_TURN.symbol).factors)),
        task=Task(_EVERYWHERE, Turning.FULL),
    )
    return replace(with_normal_chain(turned), drawn=mechanism.drawn)


def without_tool_turn(mechanism: Mechanism) -> Mechanism:
    """The machine as it is described, of an arm with the turn of the tool."""
    joints = tuple(j for j in mechanism.joints if not j.free)
    if mechanism.chain is None or joints == mechanism.joints:
        return mechanism
    factors = tuple(f for f in mechanism.chain.factors if TOOL_TURN.symbol not in f.amount.free_symbols)
    return replace(mechanism, joints=joints, chain=Chain(factors), task=Task(_EVERYWHERE, Turning.DIRECTION))
