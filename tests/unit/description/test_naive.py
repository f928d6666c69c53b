"""Descriptions as people write them who write one for the first time: each fault is told by a sentence, at once."""

import re
import time
from pathlib import Path

import pytest

from derive.description.catalogue import load
from derive.description.mechanism import DescriptionError, Mechanism
from derive.faults import Failure
from derive.pipeline import _attempt

HEAD = """from sympy import cos, sin, pi, sqrt
from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz, denavit_hartenberg
from derive.mechanism import *
A1, A2, A3, A4, A5, A6 = (rotary(f"A{k}", "turn") for k in (1, 2, 3, 4, 5, 6))
Z1 = linear("Z1", "lift")
L1 = length("link_1", "first link", nominal=300.0)
L2 = length("link_2", "second link", nominal=250.0)
"""
CHAIN = "Rz(A1) * Tx(L1) * Rz(A2) * Tx(L2) * Tz(Z1) * Rz(A4)"
SOUND = {
    "name": '"Kin_Naive"',
    "vendor": "Vendor.TEXTBOOK",
    "family": '"scara"',
    "source": '"none"',
    "summary": '"A machine."',
    "joints": "(A1, A2, Z1, A4)",
    "parameters": "(L1, L2)",
    "task": 'Task("xyz", Turning.ABOUT_Z)',
    "chain": CHAIN,
    "branches": '(branch("elbow", sin(A2), right=1, left=-1),)',
}


def written(first: str = "", **changes: str) -> str:
    """The text of a description: `first` before the mechanism, some of its parts changed, or left out where empty."""
    parts = {name: part for name, part in {**SOUND, **changes}.items() if part}
    return HEAD + first + "\nMECHANISM = Mechanism(" + ", ".join(f"{n}={p}" for n, p in parts.items()) + ")\n"


def chained(part: str, other: str) -> str:
    """The text with another part of the chain."""
    return written(chain=CHAIN.replace(part, other))


def nominal(value: str) -> str:
    return written(f'L1 = length("link_1", "link", nominal={value})')


FAULTS = {
    "a joint too few in the list": (written(joints="(A1, A2, Z1)"), "chain reads 'A4', which is not a joint or a par"),
    "a joint too few in the chain": (chained("* Tz(Z1) ", ""), "joint 'Z1' occurs nowhere in"),
    "a joint listed twice": (written(joints="(A1, A1, Z1, A4)"), "joint 'A1' is given 2 times"),
    "a joint by its name": (chained("A1", '"A1"'), "TypeError: Rz('A1') needs a joint, a param"),
    "names for joints": (written(joints='("A1", "A2")'), "joints must not hold 'A1': as in joints=(A1, A2)"),
    "names for parameters": (written(parameters='("link_1",)'), "parameters must not hold 'link_1': as in"),
    "one joint without a comma": (written(joints="(A1)"), "joints must be a tuple, not a Joint: a comma makes"),
    "a matrix for a chain": (written(chain=f"({CHAIN}).matrix()"), "chain must not be a ImmutableDenseMatrix: as in"),
    "a list for a chain": (written(chain="[Rz(A1), Tx(L1)]"), "chain must not be a list: as in chain=Rz(A1) * Tx(L1)"),
    "a length that is no number": (nominal('float("nan")'), "parameter 'link_1': its nominal value is not a number"),
    "a length of nothing": (nominal("None"), "parameter 'link_1': None is not a number"),
    "a length of zero": (nominal("0"), "parameter 'link_1': its nominal value 0 is outside its range ]0 .. 1e+09]"),
    "an exception in a function": (
        written("def chain():\n    return 1 / 0\n", chain="chain()"),
        "ZeroDivisionError: division by zero",
    ),
    "a comparison in the chain": (
        chained("Z1", "Z1.symbol > 0"),
        "Tz(z1 > 0) of the chain is given what is true or false: it needs an angle or a length",
    ),
    "a comparison for an indicator": (
        written(branches='(branch("elbow", A2.symbol > 0, right=1, left=-1),)'),
        "branch 'elbow' holds a2 > 0, which is true or false: state the quantity whose sign tells",
    ),
    "a comparison for a positive quantity": (
        written(positive="(A2.symbol > 0,)"),
        "positive holds a2 > 0, which is true or false: state the quantity whose sign tells",
    ),
    "one positive quantity": (written(positive="sin(A2)"), "positive must be a tuple, not a sin, as in positive=(R,)"),
    "a row that the joints move and nobody commands": (
        written(task='Task("xz")', joints="(A1, A2)", chain="Rz(A1) * Tx(L1) * Ry(A2) * Tx(L2)", branches=""),
        'y is not commanded but the joints move it; command it too: task=Task("xyz"); or let it move: passive="y"',
    ),
    "more rows than joints": (
        written(task='Task("xyz", Turning.FULL)'),
        "the task commands 6 quantities (x, y, z, turn x, turn y, turn z), and there are only 4 joints; command less",
    ),
    "fewer rows than joints": (written(task='Task("xy")'), "2 joints too many: the task commands 2 quantities (x, y)"),
    "no link between two axes": (
        written(chain=CHAIN.replace("* Tx(L2) ", ""), parameters="(L1,)"),
        "the closure does not determine a2, a4: 4 unknowns in 5 equations (x, y, z, cos heading, sin heading) leave 1",
    ),
    "a branch without a comma": (
        written(branches='branch("elbow", sin(A2), right=1, left=-1)'),
        "branches must be a tuple, not a Branch: a comma makes the tuple, as in branches=(branch(",
    ),
    "an indicator in degrees": (
        written(branches='(branch("elbow", sin(A2) - 90, right=1, left=-1),)'),
        "its indicator agrees with 0 steps, not one: its sign must change where two solutions meet, those for a2",
    ),
    "degrees": (chained("Rz(A2)", "Rz(90) * Rz(A2)"), "Rz(90) of the chain turns by 90 radians"),
    "a size for a length": (
        written(chain=CHAIN.replace("Tz(Z1)", "Tz(abs(Z1.symbol))")),
        "Tz(Abs(z1)) of the chain holds Abs(z1): it is made of +, -, *, powers, sines and cosines",
    ),
    "the root of a joint": (
        written(chain=CHAIN.replace("Tz(Z1)", "Tz(sqrt(Z1.symbol))")),
        "Tz(sqrt(z1)) of the chain holds sqrt(z1): it is made of",
    ),
    "one over a joint": (chained("Tz(Z1)", "Tz(1 / Z1.symbol)"), "Tz(1/z1) of the chain holds 1/z1: it is made of"),
    "a flange that is tilted": (
        chained("Rz(A4)", "Rx(pi / 4) * Rz(A4)"),
        "its rotation is not one turn about z, it turns about z, x, z; command the whole rotation, or a direction, or",
    ),
    "a word for a vendor": (written(vendor='"Acme"'), "vendor must not be 'Acme': as in vendor=Vendor.TEXTBOOK"),
    "a class with a blank": (
        written(class_name='"My Arm"'),
        "'My Arm' cannot name a class of Python; take letters and",
    ),
    "a class called as a word": (
        written(class_name='"class"'),
        "'class' cannot name a class of Python; take letters and",
    ),
    "a name for a held joint": (written(held='("A1",)'), "held must not hold 'A1': as in held=(E1,)"),
    "three numbers in a row of a table": (
        written(chain="denavit_hartenberg((A1, 0, L1), (A2, 0, L2, 0))"),
        "ValueError: not enough values to unpack (expected 4, got 3)",
    ),
    "a length divided by zero": (chained("Tx(L1)", "Tx(L1 / 0)"), "holds what is no number"),
    "a field of a joint with a typing error": (
        written('A2 = rotary("A2", "turn", limit=(-90, 90))'),
        "unexpected keyword argument 'limit'; did you mean 'limits'?",
    ),
    "a joint in small letters": (chained("A2", "a2"), ":9: NameError: name 'a2' is not defined; did you mean 'A2'?"),
    "a misspelt member": (
        written(task='Task("xyz", Turning.ABOUTZ)'),
        ":9: AttributeError: ABOUTZ; did you mean 'ABOUT_Z'?",
    ),
    "a misspelt function of a module": (
        written("import sympy", branches='(branch("elbow", sympy.Sin(A2), right=1, left=-1),)'),
        "AttributeError: module 'sympy' has no attribute 'Sin'; did you mean 'sin'?",
    ),
    "a slide times a length": (
        chained("Tz(Z1)", "Tz(L1 + Z1 * L1 / 2)"),
        "of the chain shifts by link_1*z1/2, which is no length: its powers must add to 1",
    ),
    "a misspelt import": (written("from derive.mechanism import Mechanizm"), "did you mean 'Mechanism'?"),
    "a joint as a factor": (chained("Rz(A2)", "A2"), "TypeError: A2 is a number, not a frame: as in Rz(A2) or Tz(A2)"),
    "a joint as the first factor": (
        chained("Rz(A1)", "A1"),
        "TypeError: a chain is a product of frames, not a number: as in Rz(A1) * Tx(L1)",
    ),
    "a character of zero": (written() + "A9 = 1\0", ":10: the line holds a byte that is 0"),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_the_fault_is_told(fault: str, tmp_path: Path) -> None:
    """One sentence that names the line or the part, and what is wrong; never an error of the compiler."""
    text, sentence = FAULTS[fault]
    path = tmp_path / "kin_naive.py"
    path.write_text(text)
    start = time.process_time()
    try:
        answer = _attempt(None, (path, load(path)))
        told = answer.message if isinstance(answer, Failure) else ""
    except DescriptionError as problem:
        told = str(problem)
    assert sentence in told, told
    assert not re.search(r"\(\w+\.py:\d+\)$", told), "an error of the compiler"
    assert time.process_time() - start < 20.0


def test_lists_are_as_good_as_tuples(tmp_path: Path) -> None:
    path = tmp_path / "kin_naive.py"
    path.write_text(written(joints="[A1, A2, Z1, A4]", parameters="[L1, L2]"))
    assert load(path).joints == load_sound(tmp_path).joints


def load_sound(folder: Path) -> Mechanism:
    path = folder / "kin_sound.py"
    path.write_text(written())
    return load(path)
