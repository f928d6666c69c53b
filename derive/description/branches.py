"""Branches and assembly modes: two solutions that the sign of an indicator tells apart.

An indicator is an expression of joints (for an assembly mode, of joints and position). So the meaning of a branch does
not depend on the route of the derivation.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from derive.description.errors import DescriptionError
from derive.description.fields import expression


@dataclass(frozen=True)
class Branch:
    """Two solutions told apart by the sign of an indicator: byte 1 is names[0], byte 2 names[1]."""

    name: str
    indicator: sp.Expr
    names: tuple[str, str]
    signs: tuple[int, int]
    margin: str
    """The name of the singularity at which its two solutions meet."""
    meanings: tuple[str, str] = ("", "")
    """The meanings of both names, where the branch was named by the derivation and not by a description."""

    @property
    def is_crossing(self) -> bool:
        """Whether it is a branch that tells the roots of a search apart: its indicator is the slope of the residual."""
        return bool(self.indicator is sp.nan)

    @property
    def home_flag(self) -> str:
        """The parameter that is true if the machine is on the second side of this branch at its home pose."""
        return f"home_{self.name}_{self.names[1]}"


@dataclass(frozen=True)
class Assembly:
    """The two assembly modes of a closed loop, told apart by the sign of an indicator in joints and position.

    The assembly mode is a parameter of the machine, `<name>_<second>`: forward kinematics gets axes alone.
    """

    name: str
    indicator: sp.Expr
    names: tuple[str, str]
    signs: tuple[int, int]
    margin: str
    handedness: sp.Expr = sp.Integer(1)
    """An expression of parameters. If it is negative (legs numbered the other way round) the indicator changes its
    sign."""
    meanings: tuple[str, str] = ("", "")
    """The meanings of both names, where the mode was named by the derivation and not by a description."""

    @property
    def parameter(self) -> str:
        """The name of the flag that chooses the second mode."""
        return f"{self.name}_{self.names[1]}"


def branch(name: str, indicator: object, *, margin: str | None = None, **names: int) -> Branch:
    """A branch by its indicator: `branch("elbow", sin(A2), right=+1, left=-1)`; the first name is byte 1."""
    first, second = _two_names(f"branch {name!r}", names)
    return Branch(
        name, expression(f"branch {name!r}", indicator), (first[0], second[0]), (first[1], second[1]), margin or name
    )


def crossing(name: str, **names: int) -> Branch:
    """A branch that tells the roots of a search apart: whether the residual rises or falls with the joint there."""
    return branch(name, sp.nan, margin=None, **names)


def assembly(name: str, indicator: object, *, margin: str, handedness: object = 1, **names: int) -> Assembly:
    """Two assembly modes: `assembly("tcp", Y - KNEE_Y, margin="arms_aligned", below=-1, above=+1)`; the first is the
    default.
    """
    first, second = _two_names(f"assembly {name!r}", names)
    return Assembly(
        name,
        expression(f"assembly {name!r}", indicator),
        (first[0], second[0]),
        (first[1], second[1]),
        margin,
        sp.sympify(handedness),
    )


def _two_names(what: str, names: dict[str, int]) -> tuple[tuple[str, int], tuple[str, int]]:
    if len(names) != 2 or sorted(names.values()) != [-1, 1]:
        raise DescriptionError(f"{what} needs two names with the signs +1 and -1, not {names}")
    first, second = names.items()
    return first, second
