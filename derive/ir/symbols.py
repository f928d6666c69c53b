"""Every name that programs share, as a symbol; branch signs, and the names of values that belong to some of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product
from typing import TYPE_CHECKING

import sympy as sp
from sympy.core.relational import Relational
from sympy.logic.boolalg import Boolean, BooleanAtom

from derive.ir.constants import DEGREE

if TYPE_CHECKING:
    from derive.ir.program import Program


class Flag(sp.Symbol):
    """A name that is true or false: a condition by itself."""


@cache
def real(name: str) -> sp.Symbol:
    """The name of a real number or of an angle: see `types`."""
    return sp.Symbol(name, real=True)


@cache
def flag(name: str) -> sp.Symbol:
    """The name of a truth value."""
    return Flag(name)


@cache
def count(name: str) -> sp.Symbol:
    """The name of an integer: a sign, the number of a turn or of a status, a count of passes."""
    return sp.Symbol(name, integer=True)


def is_count(symbol: sp.Basic) -> bool:
    """Whether a symbol is the name of an integer."""
    return isinstance(symbol, sp.Symbol) and bool(symbol.is_integer)


def is_condition(value: sp.Basic) -> bool:
    """Whether a value is true or false: a comparison, a combination of comparisons, or a flag."""
    return isinstance(value, Flag) or (isinstance(value, Boolean) and not value.is_Symbol)


def compared(kind: type[Relational], left: sp.Expr, right: sp.Expr | int) -> Relational:
    """A comparison, not evaluated. SymPy would first try to decide it, which takes long, and never succeeds for names
    that may have any value.
    """
    return kind(left, right, evaluate=False)


def replaced(expression: sp.Basic, names: Mapping[sp.Basic, sp.Basic]) -> sp.Basic:
    """The expression with some names replaced. To save time it is returned at once where it reads none of them."""
    return expression if names.keys().isdisjoint(names_in(expression)) else expression.xreplace(names)


def is_decided(value: object) -> bool:
    """Whether a condition is the constant true or false. Tested by its type: SymPy compares slowly."""
    return isinstance(value, BooleanAtom)


def called(name: str, like: sp.Symbol) -> sp.Symbol:
    """A name of the same type as `like`, without the assumptions that the solver makes about `like`."""
    return flag(name) if isinstance(like, Flag) else count(name) if is_count(like) else real(name)


def symbols_of(expression: sp.Basic) -> set[sp.Symbol]:
    """The free symbols of an expression, without `DEGREE`."""
    return set(names_in(expression))


@cache
def names_in(expression: sp.Basic) -> frozenset[sp.Symbol]:
    """`symbols_of` as a frozen set; cached, because the same expressions are asked for many times."""
    return frozenset(s for s in expression.free_symbols if isinstance(s, sp.Symbol)) - {DEGREE}


def sine(angle: sp.Symbol) -> sp.Symbol:
    """The name of an angle's sine."""
    return real(f"sin_{angle.name}")


def cosine(angle: sp.Symbol) -> sp.Symbol:
    """The name of an angle's cosine."""
    return real(f"{_COSINE}{angle.name}")


def angle_of(name: sp.Symbol) -> sp.Symbol | None:
    """The angle whose cosine has this name; None for any other name. Rules call this, and never inspect a name."""
    return real(name.name.removeprefix(_COSINE)) if name.name.startswith(_COSINE) else None


def branch_sign(branch: str) -> sp.Symbol:
    """The sign of a branch: +1 for byte 1, -1 for byte 2."""
    return count(f"{_SIGN}{branch}")


def is_branch_sign(name: sp.Symbol) -> bool:
    """Whether a name is that of a branch's sign."""
    return is_count(name) and name.name.startswith(_SIGN)


def branch_with(sign: sp.Symbol) -> str:
    """The branch whose sign has this name."""
    return str(sign.name.removeprefix(_SIGN))


def angle_word(name: sp.Symbol) -> str:
    """The name of the angle whose cosine, or whose direction's x, has this name: `cos_q2` → `q2`."""
    return str(name.name.removeprefix(_COSINE).removeprefix("direction_x_"))


_COSINE, _SIGN = "cos_", "sigma_"
COORDINATE_NAMES = ("x", "y", "z")
ROTATION_ENTRIES: tuple[sp.Symbol, ...] = tuple(real(f"r{i}{j}") for i in "123" for j in "123")
"""The rotation of a frame, by rows."""

HEADING = real("heading")
OFFSET = tuple(real(f"point_{c}") for c in COORDINATE_NAMES)
"""The point off the flange, in flange coordinates."""

ASSEMBLY_SIGN = real("assembly_sign")
"""The sign of det A at the home pose: the assembly mode of the machine."""
SCALE = real("machine_scale")
"""A length of the machine: the sum of its lengths, or one user's unit where it has none; the mean leg of a platform."""
MIN_TYPE2_MARGIN = "min_type2_margin"
CHECK_FORWARD = "check_forward"
"""Whether the inverse refuses a pose that forward kinematics from the home pose does not find again."""
MAX_MISS = "max_miss"
"""The largest length by which a surplus rod may miss the pose of the others."""
DETERMINANT = real("determinant")
POSITION = tuple(map(real, COORDINATE_NAMES))
HOME_ROTATION = tuple(real(f"home_{r.name}") for r in ROTATION_ENTRIES)

FLANGE_AXIS = tuple(real(f"flange_axis_{c}") for c in COORDINATE_NAMES)
"""The line about which the carrying flange turns, in the frame of the flange; zero if the flange turns freely."""
BASE_AXIS = tuple(real(f"base_axis_{c}") for c in COORDINATE_NAMES)
"""The line of `FLANGE_AXIS` as the base sees it."""

START_POSITION = tuple(real(f"start_{c}") for c in COORDINATE_NAMES)
START_ROTATION = tuple(real(f"start_{r.name}") for r in ROTATION_ENTRIES)

TRIED, SIDE = real("tried"), count("side")
"""Where a trial of a root search is made: the joint value, and the side of a two-root step: 1 the wanted one, -1."""

BOUND_OF = "bound_of_"
"""How the names of bounds begin that allow for the rounding of a machine whose lengths differ much: 1, but for that."""

REFUSAL = "refusal"
"""An output of a branch: 0 where it has a solution, else the number of its status, which is its place in `Status`."""

Choice = tuple[int, ...]
"""+1 or -1 for each of some signs."""


@dataclass(frozen=True)
class Sign:
    """A branch sign, and the names of its two values."""

    symbol: sp.Symbol
    words: tuple[str, str]
    """For +1 and for -1."""


def choices(count: int) -> Iterator[Choice]:
    """All assignments of that many signs, slot by slot: the first sign varies fastest, +1 before -1."""
    return (tuple(reversed(choice)) for choice in product((1, -1), repeat=count))


def suffixed(name: str, signs: Sequence[Sign], choice: Choice) -> str:
    """A name with the words of the signs behind it: `axis_a1_right`."""
    return "_".join([name, *(s.words[0] if value > 0 else s.words[1] for s, value in zip(signs, choice, strict=True))])


def without_words(name: str, signs: Sequence[Sign]) -> tuple[str, tuple[str, ...]]:
    """A name without the words of signs at its end, and these words."""
    found: list[str] = []
    for sign in reversed(signs):
        word = next((w for w in sign.words if name.endswith(f"_{w}")), None)
        if word is not None:
            name, found = name.removesuffix(f"_{word}"), [word, *found]
    return name, tuple(found)


_LONGEST = 80
"""The most letters of a new name, without its number."""


class Names:
    """The names in use, also if a language joins the words of a name. A new name is in use as soon as it is made."""

    def __init__(self, taken: Iterable[str]) -> None:
        """taken: the names in use, written as a program writes them, with underscores between words."""
        self._joined = {name.replace("_", "") for name in taken}

    @classmethod
    def of(cls, program: Program) -> Names:
        """The names that a program reads or binds."""
        return cls(s.name for s in (*program.inputs, *program.bound()))

    def fresh(self, proposal: str, like: sp.Symbol | None = None) -> sp.Symbol:
        """The proposed name, shortened if it is too long, and followed by a number if it is in use.

        like: a symbol whose type the new name gets; without it the new name is a real number.
        """
        if len(proposal) > _LONGEST:  # its begin says what the value is, its end where it belongs
            begin, end = proposal[: _LONGEST // 2], proposal[-_LONGEST // 2 :]
            proposal = f"{begin.rpartition('_')[0] or begin}_{end.partition('_')[2] or end}"
        number, name = 1, proposal
        while name.replace("_", "") in self._joined:
            number += 1
            name = f"{proposal}_{number}"
        self._joined.add(name.replace("_", ""))
        return real(name) if like is None else called(name, like)
