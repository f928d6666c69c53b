"""Machines whose texts hold what ends a comment, a text, an element or a line in some language; and plain twins."""

from collections.abc import Callable
from itertools import count

from sympy import cos, sin

from derive.description.mechanism import Constraint, Mechanism
from derive.frames import Rz, Tx, Tz
from derive.mechanism import Task, X, Y, assembly, branch, length, limited, linear, rod, rotary
from derive.vectors import cross, minus, vector

MARKS = (
    "*/ globalThis.HIT = 1; /*",
    "// x",
    '"""',
    "'''",
    "'); RETURN; (*",
    '"; import os; "',
    "*) END_VAR (*",
    "{attribute 'hide'}",
    "]]>",
    "</script><script>globalThis.HIT = 1</script>",
    "<img src=x onerror=alert(1)>",
    "--><b>",
    "%s %n %(x)d",
    "$N $' ${HIT} $$",
    "`HIT` ``x`` |x| x_ _x [1]_ *x* **x**",
    "{{ 7*7 }} {% raw %} @{ x }@ << x >>",
    "\\n \\",
    "???/ ??/",
    "# x",
    ".. raw:: html",
    "===== ::",
    "&amp; &#0; ~x~ \\u0041",
    "END_METHOD END_FUNCTION_BLOCK",
    "x" * 130 + "\\" * 3,
)
UNPRINTED = (
    "\0", "\x07", "\x1b[2J", "\n", "\r", "\t", "\x85", "\u2028", "\u2029", "\u202e", "\u2066", "\ufeff", "\ud800",
)  # fmt: skip
Texts = Callable[[], str]


def hostile() -> Texts:
    """Texts, each of which begins and ends with another mark and holds all of them."""
    numbers = count()

    def text() -> str:
        start = next(numbers) % len(MARKS)
        return " ".join(MARKS[start:] + MARKS[:start])

    return text


def plain() -> Texts:
    """Texts with nothing in them that any language knows."""
    return lambda: "a plain text"


def arm(text: Texts) -> Mechanism:
    """A SCARA with every kind of text that a chain can have."""
    first, second, quill = rotary("A1", text()), rotary("A2", text()), linear("A3", text(), limits=(-90.0, 90.0))
    upper, lower = length("upper", text(), nominal=300.0), length("lower", text(), nominal=250.0)
    return Mechanism(
        name="Kin_HostileArm",
        joints=(first, second, quill),
        parameters=(upper, lower),
        chain=Rz(first) * Tx(upper) * Rz(second) * Tx(lower) * Tz(quill),
        task=Task("xyz"),
        branches=(branch("elbow", sin(second), right=+1, left=-1),),
        limited=(limited("spread", first + second, text(), angle=True),),
        constraints=(Constraint(lower.symbol < 2 * upper.symbol, text()),),
        source=text(),
        summary=text(),
        title=text(),
        notes=(text(), text()),
    )


def five_bar(text: Texts) -> Mechanism:
    """A five-bar linkage: a loop with an assembly mode."""
    joints = tuple(rotary(f"A{k}", text()) for k in (1, 2))
    arms = [length(f"arm_{k}", text(), nominal=200.0) for k in (1, 2)]
    rods = [length(f"rod_{k}", text(), nominal=300.0) for k in (1, 2)]
    apart = length("apart", text(), nominal=150.0)
    knees = [
        (side * apart / 2 + one * cos(joint), one * sin(joint))
        for side, one, joint in zip((-1, 1), arms, joints, strict=True)
    ]
    lines = [minus(vector(X, Y), vector(*knee)) for knee in knees]
    return Mechanism(
        name="Kin_HostileBars",
        joints=joints,
        parameters=(*arms, *rods, apart),
        rods=tuple(rod(str(k), knees[k], (X, Y), rods[k]) for k in (0, 1)),
        task=Task("xy"),
        assembly=assembly("tcp", cross(*lines), margin="aligned", below=-1, above=+1),
        source=text(),
        summary=text(),
        notes=(text(),),
    )


MADE: dict[str, Callable[[Texts], Mechanism]] = {"chain": arm, "loop": five_bar}
