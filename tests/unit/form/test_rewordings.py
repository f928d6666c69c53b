"""Every chain in two of three other wordings of its own: in frames that are moved and turned, in link frames at any
place, by tables.

Their form is the same, numbers to 11 digits, so what is derived of them is the same: solutions, operations, time, and
why it is refused.
What is derived of some is measured against the first wording all the same.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import sympy as sp

from derive.description.amounts import with_exact_angles
from derive.description.mechanism import DescriptionError, Mechanism, Task, Turning, linear
from derive.description.validate import validate
from derive.form.machine import in_form
from derive.frames import Rx, Ry, Rz, Tx, Ty, Tz
from derive.geometry.frames import Chain
from derive.ir.program import Let
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.solver.unsolved import Unsolved
from derive.witness import witness
from tests.machines.made import made
from tests.mechanisms import catalogue, kinematics_of
from tests.unit.form.chains import A2, A3, A4, CHAINS
from tests.unit.form.link_frames import by_table, in_link_frames
from tests.unit.form.rewording import reworded
from tests.unit.form.test_chain import frame, in_words

pytestmark = pytest.mark.slow

MACHINES = {**CHAINS, **{m.name: m for _, m in catalogue() if m.chain is not None}}
WORDINGS = 2
WAYS: tuple[Callable[[Mechanism, int], Chain], ...] = (reworded, in_link_frames, by_table)
DERIVED = ("five axes with a tool beside the last one", "SCARA that is turned where it stands")


def other(mechanism: Mechanism, number: int) -> Mechanism:
    """A machine in another of its wordings."""
    return replace(mechanism, chain=WAYS[number % len(WAYS)](mechanism, number))


def rounded(chain: Chain | None) -> list[tuple[object, ...]]:
    """The factors of a chain, with numbers to 11 digits: in oblique frames the 14th is rounding."""
    assert chain is not None
    return [(f.motion, f.axis, sp.expand(f.amount).evalf(11)) for f in chain.factors]


@pytest.mark.parametrize("name", MACHINES)
def test_other_words_have_the_same_form(name: str) -> None:
    mechanism, form = MACHINES[name], in_form(MACHINES[name])
    rng = np.random.default_rng(3)
    values = {q.symbol: float(rng.uniform(0.5, 1.5)) for q in (*mechanism.parameters, *mechanism.joints)}
    stated = frame(with_exact_angles(mechanism).chain, values)
    first = WORDINGS * list(MACHINES).index(name)
    for number in range(first, first + WORDINGS):
        again = other(mechanism, number)
        assert frame(again.chain, values) == pytest.approx(stated, rel=1e-10, abs=1e-9), f"wording {number}"
        found = in_form(again)
        assert rounded(found.chain) == rounded(form.chain), f"wording {number}: {in_words(again.chain)}"
        assert replace(found, drawn=None, chain=form.chain) == replace(form, drawn=None), f"wording {number}"


def operations(kin: Kinematics) -> int:
    """The operations of the inverse for one branch."""
    return sum(int(sp.count_ops(s.value)) for s in kin.branch.body if isinstance(s, Let))


@pytest.mark.parametrize("name", DERIVED)
def test_what_is_derived_of_another_wording_solves_the_machine(name: str) -> None:
    """No solution is wrong, and none is missing: the witness measures it against the first description."""
    mechanism, known = made(name).mechanism, made(name).built.evidence
    again = build(validate(replace(mechanism, chain=by_table(mechanism, 1))))
    seen = witness(again, mechanism).inverted
    assert known is not None and known.inverted is not None
    assert seen is not None and seen.solutions == known.inverted.solutions
    assert operations(again) == operations(kinematics_of(mechanism))


ROLLED = Task("xyz", Turning.PITCH_ROLL)
_TRACK, _QUILL = linear("A1", "track"), linear("A5", "quill")
_BETWEEN = Tx(_TRACK) * Rz(A2) * Ty(50) * Ry(A3) * Tx(70) * Rx(A4) * Ty(80) * Tz(_QUILL) * Tx(30) * Ry(1)
REFUSED = {
    "a flange that leans": replace(CHAINS["SCARA"], chain=CHAINS["SCARA"].chain * Rx(sp.pi / 2)),
    "three turns between two slides": replace(
        CHAINS["five turns"], task=ROLLED, joints=(_TRACK, A2, A3, A4, _QUILL), chain=_BETWEEN
    ),
    "a joint too many": replace(CHAINS["arm on a rail"], held=()),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_a_refusal_is_the_same_refusal(kind: str) -> None:
    sentences = set()
    for machine in (REFUSED[kind], *(other(REFUSED[kind], number) for number in range(len(WAYS)))):
        with pytest.raises((DescriptionError, Unsolved)) as problem:
            build(validate(machine))
        sentences.add(str(problem.value))
    assert len(sentences) == 1, sentences
