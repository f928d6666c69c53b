"""What branches share has room in the structure that the base block keeps for them; what has none is computed again."""

from dataclasses import replace

import pytest

from derive.description.mechanism import Mechanism
from derive.report import branch_stretches
from derive.report.branch_stretches import MOST_KEPT, MOST_SIDES, stretches_of
from tests.mechanisms import kinematics_of, named

pytestmark = pytest.mark.slow

DELTA = named("Kin_Delta_P3C_Type3")


def taken(mechanism: Mechanism) -> tuple[int, int, int]:
    """Of a fresh copy of the program of a branch: shared stretches, their sides, and the values that are kept."""
    program = replace(kinematics_of(mechanism).branch)
    shared = [s for s in stretches_of(program) if s.is_shared]
    assert all(not s.kept for s in stretches_of(program) if not s.is_shared)
    return len(shared), sum(s.sides for s in shared), sum(s.sides * len(s.kept) for s in shared)


def test_there_is_room() -> None:
    """A delta shares each of its legs, and the part that all have in common."""
    stretches, sides, values = taken(DELTA)
    assert stretches >= 4 and sides <= MOST_SIDES and values <= MOST_KEPT


@pytest.mark.parametrize("limit", ["MOST_SIDES", "MOST_KEPT"])
def test_what_has_no_room_is_computed_again(limit: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Some stretches keep their place, and all statements stay."""
    whole = taken(DELTA)
    statements = [i for s in stretches_of(kinematics_of(DELTA).branch) for i in s.items]
    monkeypatch.setattr(branch_stretches, limit, whole[1] - 1 if limit == "MOST_SIDES" else whole[2] - 1)
    fewer = taken(DELTA)
    assert 0 < fewer[0] < whole[0] and fewer[1] < whole[1] and fewer[2] < whole[2]
    assert [i for s in stretches_of(replace(kinematics_of(DELTA).branch)) for i in s.items] == statements
    monkeypatch.setattr(branch_stretches, limit, 0)
    assert taken(DELTA) == (0, 0, 0)
