"""The blocks that set and read configurations, and the relation between configurations."""

from itertools import product
from typing import Any

import pytest

from derive.description.mechanism import Mechanism
from tests.text import values
from tests.text.comparisons.configurations import padded
from tests.text.controller import BAD_INPUT, asked, assert_same
from tests.text.pairs import POSITION_KINEMATICS, Pair, pairs_of

CONFIGURABLE = [m for m in POSITION_KINEMATICS if m.branches or m.period_joints]
PERIODS = (0, 1, 2, 127, -1, -2, -127)
NO_PERIODS = (128, -128, 300, 32767, -32768)
"""Turns that a byte cannot hold."""


@pytest.fixture(params=CONFIGURABLE, ids=lambda m: m.name)
def one(request: pytest.FixtureRequest) -> Pair:
    return pairs_of(request.param)[1]


@pytest.mark.long("Hexapod")
def test_who_has_them(pairs: tuple[Pair, ...]) -> None:
    """A machine with one solution has no configuration, and no such blocks."""
    has_blocks = f"{pairs[0].mechanism.block_name}_Config" in pairs[0].library.objects
    assert has_blocks == (pairs[0].mechanism in CONFIGURABLE) == bool(pairs[0].robot.CONFIGURATION)


def words(name: str) -> str:
    return "".join(word[:1].upper() + word[1:] for word in name.split("_"))


def inputs(mechanism: Mechanism, branches: tuple[int, ...], periods: tuple[int, ...]) -> dict[str, Any]:
    """The inputs of the setting block for branch bytes and period numbers."""
    given: dict[str, Any] = {}
    for branch, byte in zip(mechanism.branches, branches, strict=True):
        given[f"x{words(branch.name)}{words(branch.names[0])}"] = byte == 1
        given[f"x{words(branch.name)}Automatic"] = byte == 0
    return given | {f"iPeriod{words(j.key)}": n for j, n in zip(mechanism.period_joints, periods, strict=True)}


def outputs(one: Pair, data: tuple[int, ...]) -> dict[str, Any]:
    """What the reading block shows of configuration bytes."""
    block = one.library.new(one.mechanism.block_name + "_ReadConfig")
    block(Config=values.configuration(one.library, data))
    names = [*inputs(one.mechanism, (0,) * one.robot.BRANCHES, (0,) * len(one.robot.PERIOD_AXES))]
    names += [f"x{words(b.name)}Singular" for b in one.mechanism.branches]
    return {name: getattr(block, name) for name in names}


def configured(one: Pair, given: dict[str, Any]) -> tuple[int, ...]:
    """All bytes that the setting block writes."""
    block = one.library.new(one.mechanism.block_name + "_Config")
    block(**given)
    return tuple(block.Config.abyData)


def test_what_is_set_is_read(one: Pair) -> None:
    counts = one.robot.BRANCHES, len(one.robot.PERIOD_AXES)
    for branches in product((0, 1, 2), repeat=counts[0]):
        for turn in PERIODS:
            periods = tuple(turn if i % 2 == 0 else -turn for i in range(counts[1]))
            given = inputs(one.mechanism, branches, periods)
            data = configured(one, given)
            assert data == padded((*branches, *periods))
            singular = {f"x{words(b.name)}Singular": False for b in one.mechanism.branches}
            assert outputs(one, data) == given | singular


def test_without_inputs_it_is_the_default(one: Pair) -> None:
    assert configured(one, {}) == padded(one.robot.DEFAULT_CONFIGURATION)


def test_a_turn_that_a_byte_cannot_hold_is_automatic(one: Pair) -> None:
    size = len(one.robot.PERIOD_AXES)
    for turn in NO_PERIODS:
        given = inputs(one.mechanism, (1,) * one.robot.BRANCHES, (turn,) * size)
        assert configured(one, given) == padded((1,) * one.robot.BRANCHES + (0,) * size)


def test_every_byte_can_be_read(one: Pair) -> None:
    """The reading block shows every byte as the branch, the turn or the coincidence that it means."""
    branches, periods = one.robot.BRANCHES, len(one.robot.PERIOD_AXES)
    for byte in range(256):
        found = outputs(one, (byte,) * (branches + periods))
        number = byte - 256 if byte > 127 else byte
        for branch in one.mechanism.branches:
            stem = f"x{words(branch.name)}"
            shown = found[stem + words(branch.names[0])], found[stem + "Automatic"], found[stem + "Singular"]
            assert shown == (byte == 1, byte == 0, byte == 3)
        assert all(found[f"iPeriod{words(j.key)}"] == number for j in one.mechanism.period_joints)


def test_what_is_set_drives_inverse_kinematics(one: Pair) -> None:
    """Every choice of the setting block, given to CartesianToAxes as it is."""
    found = set()
    choices = product(product((0, 1, 2), repeat=one.robot.BRANCHES), (0, 1, 2, -1))
    for (branches, turn), sample in zip(choices, one.regular, strict=False):
        chosen = branches + (turn,) * len(one.robot.PERIOD_AXES)
        (position, rotation), _ = one.robot.forward(sample.axes)
        data = configured(one, inputs(one.mechanism, branches, chosen[len(branches) :]))
        status, axes = asked(one.robot.inverse, (position, rotation), chosen, sample.reference)
        answer = one.controller.inverse(position, rotation, data, sample.reference)
        assert_same(answer, (status, axes and axes + (0.0,) * (6 - len(axes))), one, chosen, sample)
        found.add(answer)
    assert len(found) > 3


def test_a_branch_byte_that_means_nothing_is_refused(one: Pair) -> None:
    sample = one.regular[0]
    (position, rotation), own = one.robot.forward(sample.axes)
    for index, byte in product(range(one.robot.BRANCHES), range(4, 256)):
        data = (*own[:index], byte, *own[index + 1 :])
        assert one.controller.inverse(position, rotation, data, sample.axes) == (BAD_INPUT, None)


def test_connectible_is_an_equivalence_of_branch_bytes(one: Pair) -> None:
    """Over all branch bytes 0 to 3; the period bytes differ everywhere."""
    size, branches = len(one.robot.CONFIGURATION), one.robot.BRANCHES
    all_bytes = list(product(range(4), repeat=branches))
    turns = {data: tuple((7 * i + sum(data)) % 256 for i in range(size - branches)) for data in all_bytes}

    def connectible(first: tuple[int, ...], second: tuple[int, ...]) -> bool:
        given = {"cd1": first + turns[first], "cd2": second + turns[second]}
        arguments = {name: values.configuration(one.library, data) for name, data in given.items()}
        found: bool = one.controller.block.call("CPConnectible", **arguments)
        return found

    classes = {a: frozenset(b for b in all_bytes if connectible(a, b)) for a in all_bytes}
    for first, second in product(all_bytes, repeat=2):
        assert connectible(first, second) == connectible(second, first) == (classes[first] == classes[second])
    assert all(classes[a] == {a} for a in all_bytes), "0 and 3 are classes of their own"
