"""Turns of a platform: the rates of its angles, and the twist of the least turn from home, where no leg feels a twist.

Let s be the sum of the directions of the tool here and at home. The least turn from home mirrors x and y of the plate
at home in the plane across s. Where it leads, the platform turns about axes across s from one pose to the next.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from derive.ir.constants import FREE_ANGLE
from derive.ir.primitives import Select
from derive.ir.program import Let, Require, Statement, Status
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import COORDINATE_NAMES, HOME_ROTATION, real

ANGLES = ("roll", "pitch", "yaw")


def rates(spin: Sequence[sp.Expr]) -> tuple[Let, ...]:
    """The rates of roll, pitch and yaw, of the names `roll_rate` and so on, at a spin w: for yaw alone, w.

    Else w = E (roll', pitch', yaw') with E = [[cp cy, -sy, 0], [cp sy, cy, 0], [-sp, 0, 1]].
    """
    if len(spin) == 1:
        return (Let(real("yaw_rate"), spin[0]),)
    roll, pitch, yaw = (real(f"{a}_rate") for a in ANGLES)
    cos_pitch, sin_pitch, cos_yaw, sin_yaw = map(real, ("cos_pitch", "sin_pitch", "cos_yaw", "sin_yaw"))
    divisor = real("cos_pitch_divisor")
    return (
        Let(divisor, Select(sp.Gt(sp.Abs(cos_pitch), FREE_ANGLE), cos_pitch, sp.Integer(1))),
        Let(roll, (cos_yaw * spin[0] + sin_yaw * spin[1]) / divisor),
        Let(pitch, cos_yaw * spin[1] - sin_yaw * spin[0]),
        Let(yaw, spin[2] + sin_pitch * roll),
    )


def least_turn(word: str, tool: sp.Matrix, called: Sequence[sp.Symbol]) -> tuple[Let, ...]:
    """2 s / s², bound to the names `called`: the row of A for a twist that no leg feels. Divided like this it makes det
    A that of a turn about the tool. word: it stands before the other names.
    """
    both = tuple(real(f"{word}_both_{c}") for c in COORDINATE_NAMES)
    square, divisor = real(f"{word}_square"), real(f"{word}_divisor")
    return (
        *(Let(n, t + h) for n, t, h in zip(both, tool, HOME_ROTATION[2::3], strict=True)),
        Let(square, sp.Add(*[n**2 for n in both])),
        Let(divisor, Select(sp.Gt(square, FREE_ANGLE), square, sp.Integer(1))),
        *(Let(n, 2 * b / divisor) for n, b in zip(called, both, strict=True)),
    )


def least_turned(tool: sp.Matrix) -> tuple[tuple[Statement, ...], sp.Matrix]:
    """The statements for a rotation with this direction of the tool and the least turn from home, and the rotation."""
    word = "least_turn"
    seen, across = (tuple(real(f"{name}_{c}") for c in COORDINATE_NAMES) for name in ("tool", "across"))
    lets = (Let(n, v) for n, v in zip(seen, tool, strict=True))
    is_one = sp.Gt(real(f"{word}_square"), FREE_ANGLE)
    refusal = Require(is_one, Status.IMPOSSIBLE, reason=about_machine(Why.OPPOSITE))
    home = sp.Matrix(3, 3, HOME_ROTATION)[:, :2]
    rotation = sp.Matrix.hstack(home - sp.Matrix(across) * (sp.Matrix([seen]) * home), sp.Matrix(seen))
    return (*lets, *least_turn(word, sp.Matrix(seen), across), refusal), rotation
