"""What to do about a refusal whose own sentence does not say it. docs/OWN_MACHINE.md explains each of them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches
from inspect import signature

from derive.description import mechanism
from derive.description.joints import JointDetails
from derive.description.mechanism import Mechanism

_FRAMES = ("Rx", "Ry", "Rz", "Tx", "Ty", "Tz", "Txyz", "flip_x")
_EXPLAIN = "`softkin explain` prints the determinant of every step"
REMEDIES: tuple[tuple[str, str], ...] = (
    (r"with offset_interface=False it could be", "write offset_interface=False, unless such points are commanded"),
    (r"defines no MECHANISM", "assign the description: MECHANISM = Mechanism(…)"),
    (r"^SyntaxError", "correct this line, or the one before it"),
    (r"^NameError", "define it above this line, or import it from derive.mechanism, derive.frames or sympy"),
    (r"^(ImportError|ModuleNotFoundError)", "joints and lengths are in derive.mechanism, frames in derive.frames"),
    (r"Mechanism\S* missing \d+ required", "state what is missing as a keyword: Mechanism(name=…, joints=…, task=…)"),
    (
        r"missing \d+ required",
        'as in length("link_length_1", "what it is", nominal=300.0), rotary("A1", "what it moves")',
    ),
    (r"must be real number|Cannot convert expression|loop of ufunc", "take sin, cos and sqrt from sympy"),
    (r"unsupported operand type\(s\) for \+: 'Chain'", "a chain is a product: Rz(A1) * Tx(L1)"),
    (r"ends the program", "let the file define MECHANISM, and nothing else"),
    (r"cannot name a function block", "take letters, digits and single _, a letter first"),
    (r"cannot name a class", 'take letters and digits, as in class_name="MyMachine"'),
    (r"cannot name a family", 'take one word, as in family="own"'),
    (r"the mechanism has no joints", "list them in the order of the axes: joints=(A1, A2)"),
    (r"is given \d+ times", "give each thing a name of its own, whatever its capital letters"),
    (r"cannot name a joint", "as in rotary('A1', …)"),
    (r"^joint .* and parameter .* differ in case alone", "name the joint's value, as in rotary('A1', …, value='q1')"),
    (r"differ in case alone", "give each thing a name of its own, whatever its capital letters"),
    (r"its range .* is empty", "state the lower end first"),
    (r"(offset_range|limit_range|limits|domain) .* (is|are) empty", "state the lower end first"),
    (r"is outside its (range|domain)", "widen the range, or take a value inside it"),
    (r"needs a limit_range", "a joint that carries a pitch always has limits: limit_range=(lower, upper)"),
    (r"which is not the motor of an earlier joint", "list the joint whose motor is read before this one"),
    (r"^held names", "hold a joint that joints=(…) lists"),
    (r"held joints need a chain", "leave out held=, or state the loop as a chain"),
    (r"^surplus (names|joint)", "name lengths of rods alone, or leave out surplus=: it is then chosen"),
    (r"^load= has", "as in load=(0, 0, -1), or load=(0, -1) in the plane"),
    (r"periods (names|must name)", "leave out periods=: the order of the axes is taken"),
    (r"needs either a chain or closure", "state chain=Rz(A1) * Tx(L1) * …, or rods=(…) of a closed loop"),
    (r"it must be coordinates in the order", 'as in task=Task("xyz")'),
    (r"a cone of a rod's joint is about", "state home=(…)"),
    (r"occurs nowhere in the closure", "use it in the chain or in a rod, or leave it out of joints=(…)"),
    (r"which is not a joint or a parameter of this", "list it in joints=(…) or in parameters=(…), or in drives=(…)"),
    (r"which is not a parameter", "list it in parameters=(…)"),
    (r"depends on no joint", "take an expression that changes its sign where the two solutions meet, as sin(A2)"),
    (r"needs two names with the signs", 'as in branch("elbow", sin(A2), right=+1, left=-1)'),
    (r"which is no parameter of this mechanism", "list it in parameters=(…)"),
    (r"the nominal parameters break", "choose nominal values that fit each other"),
    (r"the closure has \d+ equations, and", "state one equation for each commanded quantity"),
    (r"its indicator agrees with", f"{_EXPLAIN}, or leave the branch out: it is then derived"),
    (r"no branch names the two", _EXPLAIN),
    (r"name the same two solutions", f"leave one of them out; {_EXPLAIN}"),
    (r"one assembly names one", "state closed loops whose tool has two positions at most for the same axes"),
    (r"a flip must stand at the end", "put it last in the chain"),
    (r"its home pose is not where the legs reach it", "compute home=(…) from the nominal lengths"),
    (r"is not commanded but the joints move it", 'command it too: task=Task("xyz"); or let it move: passive="y"'),
    (r"its end must be a point of the plate", "write it with X, Y, Z, or with on_plate(…)"),
    (r"Initialize refuses the nominal parameters", "choose nominal values that fit each other, and a home in reach"),
    (r"a machine has no regular pose", "one joint repeats what another does: change the chain, or the task"),
    (r"do not multiply to the determinant", "state the joints and lengths separately, not their sums"),
    (
        r"was given up after [\d,]+ steps",
        "name another joint in search=, hold another one (held=), or let axes meet or be parallel",
    ),
    (
        r"the search (misses|refuses) ",
        "leave search= out, or name another joint in it; where it is not stated, hold a joint: held=(…)",
    ),
    (
        r"the home pose has \d+ assembly modes",
        "choose a home= at which every rod has a side, and no two legs are in line",
    ),
    (
        r"the way back: error inf",
        "where some lengths of that machine are 0, state those that never are by length(…), or hold a joint",
    ),
    (r"closure equations for \d+ commanded", "state one equation for each commanded coordinate"),
    (r"conditions are left, not one|may be out of reach in its", "search another joint, or leave search= out"),
    (r"is taken by|declares ", ""),
)
"""Pattern of a refusal → what to do."""


def remedy_of(problem: str) -> str:
    """What to do about a refusal; empty if its sentence says it."""
    if (
        word := re.search(r"(?:(\w+)(?:\.__init__)?\(\) got an )?unexpected keyword argument '(\w+)'", problem)
    ) is not None:
        return _another_field(word[1] or "Mechanism", word[2])
    if (word := re.search(r"name '(\w+)' is not defined|cannot import name '(\w+)'", problem)) is not None:
        return _another_name(word[1] or word[2]) or _first_remedy(problem)
    if (word := re.search(r"(\w+)\(\) missing \d+ required positional", problem)) is not None:
        return _called(word[1]) or _first_remedy(problem)
    return _first_remedy(problem)


def _first_remedy(problem: str) -> str:
    return next((remedy for pattern, remedy in REMEDIES if re.search(pattern, problem)), "")


def with_remedy(problem: str) -> str:
    """The problem, and what to do about it."""
    remedy = remedy_of(problem)
    return f"{problem}; {remedy}" if remedy else problem


def _another_field(owner: str, word: str) -> str:
    """The field that was meant, of a mechanism, a joint, or what else is called with fields."""
    known = list(signature(getattr(mechanism, owner, Mechanism)).parameters)
    if owner == "Joint":
        known = ["name", "meaning", "value", *JointDetails.__annotations__]
    close = get_close_matches(word, known, 1)
    return f"did you mean {close[0]!r}?" if close else f"the fields are {', '.join(known)}"


def _called(word: str) -> str:
    """The call of a function of the vocabulary with all that it must have; empty for another one."""
    if word not in mechanism.__all__ or word == "Mechanism":
        return ""
    needed = [p.name for p in signature(getattr(mechanism, word)).parameters.values() if p.default is p.empty]
    return f"call it as {word}({', '.join(needed)})"


def _another_name(word: str) -> str:
    """The import of a word of the vocabulary, or the one that was meant, whatever its capital letters; else empty."""
    for room, names in (("derive.mechanism", mechanism.__all__), ("derive.frames", _FRAMES)):
        if word in names:
            return f"write above it: from {room} import {word}"
    return did_you_mean(word, (*mechanism.__all__, *_FRAMES, "sin", "cos", "sqrt", "pi"))


def did_you_mean(word: str, names: Iterable[str]) -> str:
    """The question about a name that is like a word, whatever its capital letters; empty if none is."""
    known = {name.lower(): name for name in names if not name.startswith("_")}
    close = get_close_matches(word.lower(), known, 1, 0.8)
    return f"did you mean {known[close[0]]!r}?" if close and known[close[0]] != word else ""
