"""Serial machines of every kind: arms with six turns and all kinds of wrists, fewer turns, slides, held joints."""

from collections.abc import Mapping

from sympy import pi

from derive.frames import Chain, Rx, Ry, Rz, Tx, Ty, Tz, denavit_hartenberg
from derive.mechanism import Mechanism, Task, Turning, angle, length, linear, radians, rotary
from tests.machines.textbook import read_by

A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", "turn") for k in range(1, 7))
P1, P2, P3 = (linear(f"P{k}", "slide") for k in range(1, 4))
SIX = (A1, A2, A3, A4, A5, A6)
LINK, OFFSET = length("link", "link", nominal=310.0), length("offset", "offset", nominal=45.0)
LEAN = angle("lean", "lean", nominal=40.0)
STOCK = (*SIX, P1, P2, P3, LINK, OFFSET, LEAN)
FULL = Task("xyz", Turning.FULL)
AIMED = Task("xyz", Turning.DIRECTION)
ABOUT_Z = Task("xyz", Turning.ABOUT_Z)


def _of(chain: Chain, task: Task = FULL, **more: object) -> Mechanism:
    return Mechanism("Own", task=task, chain=chain, **(read_by(chain, STOCK) | more))  # type: ignore[arg-type]


ELBOW = Rz(A1) * Tz(400) * Tx(25) * Ry(A2) * Tz(455) * Ry(A3)
"""The first three turns of most arms."""
BALL = Rx(A4) * Ry(A5) * Rx(A6)
PUMA = Rz(A1) * Ry(A2) * Tz(431.8) * Ry(A3)
CHAINS: Mapping[str, Mechanism] = {
    "ball wrist": _of(ELBOW * Tz(35) * Tx(420) * BALL * Tx(80)),
    "ball wrist, shoulder beside": _of(PUMA * Ty(-149) * Tx(20.3) * Tz(433) * Rz(A4) * Ry(A5) * Rz(A6)),
    "ball wrist about x, y, z": _of(ELBOW * Tx(420) * Rx(A4) * Ry(A5) * Rz(A6) * Tz(70)),
    "ball wrist, named lengths": _of(Rz(A1) * Tx(OFFSET) * Ry(A2) * Tz(LINK) * Ry(A3) * Tx(LINK) * BALL),
    "arm that stands raised": _of(Rz(A1) * Tz(300) * Ry(A2 + pi / 6) * Tz(350) * Ry(A3 - pi / 6) * Tx(380) * BALL),
    "three parallel": _of(
        denavit_hartenberg(
            *((A1, 89, 0, pi / 2), (A2, 0, -425, 0), (A3, 0, -392, 0)),
            *((A4, 109, 0, pi / 2), (A5, 95, 0, -pi / 2), (A6, 82, 0, 0)),
        )
    ),
    "three parallel, wrist about y, z": _of(PUMA * Tz(400) * Ry(A4) * Ty(110) * Rz(A5) * Tz(95) * Ry(A6) * Ty(80)),
    "wrist with an offset along its second turn": _of(PUMA * Tx(540) * Rx(A4) * Ty(-150) * Ry(A5) * Rx(A6) * Tx(160)),
    "wrist with an offset across": _of(PUMA * Tx(500) * Rx(A4) * Ry(A5) * Tz(90) * Rx(A6) * Tx(160)),
    "wrist inclined by 60 degrees": _of(ELBOW * Tx(420) * Rx(A4) * Ry(pi / 3) * Rx(A5) * Ry(-pi / 3) * Rx(A6) * Tx(80)),
    "last two turns parallel to the first": _of(PUMA * Tx(400) * Ry(A4) * Rz(A5) * Tx(90) * Rx(A6)),
    "turns on a leaning base": _of(Rx(radians(LEAN)) * ELBOW * Tx(420) * BALL * Tx(80)),
    "first turn lying": _of(Tz(500) * Rx(A1) * Tx(100) * Ry(A2) * Tz(455) * Ry(A3) * Tx(420) * BALL),
    "Stanford": _of(Rz(A1) * Tz(412) * Ry(A2) * Ty(154) * Tz(P1) * Rz(A4) * Ry(A5) * Rz(A6) * Tz(263)),
    "Stanford, with named lengths": _of(
        Rz(A1) * Ty(OFFSET) * Rx(A2) * Ty(P1 + 50) * Ry(A4) * Rx(A5) * Ry(A6) * Ty(LINK)
    ),
    "cylinder": _of(Rz(A1) * Tz(P1) * Tx(P2) * BALL * Tx(90)),
    "gantry with a wrist": _of(Tx(P1) * Ty(P2) * Tz(P3) * Rz(A4) * Ry(A5) * Rz(A6) * Tz(-120)),
    "gantry": _of(Tx(P1) * Ty(P2) * Tz(-P3), Task("xyz")),
    "gantry with an inclined slide": _of(Tx(P1) * Ry(pi / 6) * Tz(P2) * Ry(-pi / 6) * Ty(P3), Task("xyz")),
    "crossed drives": _of(Tx((P1 + P2) / 2) * Ty((P1 - P2) / 2), Task("xy")),
    "SCARA": _of(Rz(A1) * Tx(325) * Rz(A2) * Tx(225) * Tz(P1) * Rz(A4), ABOUT_Z),
    "SCARA that hangs": _of(Rx(pi) * Rz(A1) * Tx(325) * Rz(A2) * Tx(225) * Tz(P1) * Rz(A4), ABOUT_Z),
    "SCARA, slide first": _of(Tz(P1) * Rz(A1) * Tx(LINK) * Rz(A2) * Tx(225) * Rz(A4), ABOUT_Z),
    "SCARA with an oblique arm": _of(Rz(A1 + pi / 6) * Tx(325) * Rz(A2 - pi / 6) * Tx(225) * Tz(P1) * Rz(A4), ABOUT_Z),
    "palletizer": _of(
        Rz(A1) * Tx(150) * Ry(A2) * Tz(700) * Ry(A3 - A2) * Tx(800) * Ry(-A3) * Tx(120) * Rz(A4) * Tz(-90), ABOUT_Z
    ),
    "arm with three turns": _of(ELBOW * Tx(300), Task("xyz")),
    "five turns": _of(ELBOW * Tx(300) * Ry(A4) * Rx(A5) * Tz(80), AIMED),
    "five axes, fork head": _of(Tx(P1) * Ty(P2) * Tz(P3) * Rz(A1) * Ry(A2) * Tz(-LINK), AIMED),
    "five axes, nutating head": _of(
        Tx(P1) * Ty(P2) * Tz(P3) * Rz(A1) * Rx(pi / 4) * Rz(A2) * Rx(-pi / 4) * Tz(-140), AIMED
    ),
    "five axes, tables": _of(Rx(-A1) * Ty(20) * Ry(-A2) * Tx(P1) * Ty(P2) * Tz(P3), AIMED),
    "arm on a rail": _of(Ty(P1) * ELBOW * Tx(420) * BALL * Tx(80), held=(P1,)),
    "arm with a held turn": _of(PUMA * Ty(10) * Tx(P1) * BALL * Tx(80), joints=(P1, *SIX), held=(P1,)),
    "head that only turns": _of(Rz(A1) * Ry(-A2) * Rz(A3) * Tz(50), Task("", Turning.FULL)),
    "arm that aims its pitch": _of(ELBOW * Tx(300) * Ry(A4) * Tx(80) * Ry(pi / 2), Task("xyz", Turning.PITCH)),
}
