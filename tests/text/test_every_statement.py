"""Every statement of every emitted unit is executed by the tests of this folder: none is dead, none untried."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from functools import cache, partial
from itertools import product

import numpy as np
import pytest
import softkin

from derive.description.mechanism import Mechanism
from derive.emit.st.names import capitalized
from tests.catalogue.machines import bare_machine
from tests.harness.library import Library
from tests.mechanisms import named
from tests.text import (
    test_axis_settings,
    test_blocks_alone,
    test_configuration_blocks,
    test_garbage,
    test_initialise,
    test_limits,
    test_shared_functions,
    test_shared_line,
    test_shared_matrices,
    test_shared_teach,
    test_singular_poses,
)
from tests.text.comparisons import COMPARISONS, POSELESS
from tests.text.pairs import MECHANISMS, Pair, pair_of, pairs_of
from tests.text.reasons import provoke
from tests.text.samples import Sample, coinciding
from tests.text.selftest import test_self_test
from tests.text.statements import Statements
from tests.text.units import compiled, compiled_shared, file_of, shared_texts, text_of

pytestmark = pytest.mark.slow

MACHINES = ("plain", "equal", "limited", "limited to a turn")
OF_THE_BASE = ("Kin_Scara4_ZCcoupled_Type1", "Softkin_Pos_RRR")
OF_A_DIRECTION = "Softkin_5Axes"
WITHOUT_TURN = ("Kin_Crane", "Softkin_Gantry2")
"""The blocks whose calls, together, reach every statement of the base block."""
FEW, A_FEW = 3, 9
"""The numbers of samples: a watched call takes its time."""
POSED = COMPARISONS.keys() - POSELESS
"""The methods that a pose goes into."""


def test_every_statement_runs(mechanism: Mechanism) -> None:
    """The tests execute every statement of the block of a serial mechanism.

    What no other test asks is asked in any case; what others ask, too, only as long as a statement has not run.
    """
    serial_pairs = pairs_of(mechanism)
    statements = Statements([file_of(mechanism)], libraries(mechanism))
    with statements.watched():
        test_axis_settings.every_statement_of_the_settings(mechanism)
        provoke(serial_pairs[1], serial_pairs[1].regular[0])
        for one, sample, methods in singular(mechanism, serial_pairs):
            compare_all(one, sample, methods)
        for sampled in (one for one in serial_pairs if one.machine.label in MACHINES):
            for sample in few(sampled.regular, FEW):
                compare_all(sampled, sample, POSELESS)
        for test in (*again(serial_pairs), *the_tests(mechanism, serial_pairs), *on_the_grid(serial_pairs)):
            if not left_out(mechanism, statements):
                break
            test()
    assert left_out(mechanism, statements) == []


def again(serial_pairs: tuple[Pair, ...]) -> Iterator[Callable[[], None]]:
    """A few of the samples at which `test_blocks_alone` asks all."""
    for one in (one for one in serial_pairs if one.machine.label in MACHINES):
        yield from (partial(compare_all, one, sample, POSED) for sample in few(one.regular, FEW))


def on_the_grid(serial_pairs: tuple[Pair, ...]) -> Iterator[Callable[[], None]]:
    """Singular poses: there are sides of a choice that only a few of them reach."""
    for one in serial_pairs:
        yield from (partial(compare_all, one, sample, POSED) for sample in one.grid)


def singular(mechanism: Mechanism, serial_pairs: tuple[Pair, ...]) -> Iterator[tuple[Pair, Sample, Collection[str]]]:
    """A few singular poses, of the machine with equal links and where several singularities coincide, with the methods
    that `test_singular_poses` does not ask there.
    """
    equal = (one for one in serial_pairs if one.machine.label == "equal")
    others = POSED - set(test_singular_poses.METHODS)
    yield from ((one, sample, others) for one in equal for sample in few(one.grid, A_FEW))
    if serial_pairs[0].machine.is_spatial and mechanism.branches:
        asked = POSED - set(test_singular_poses.COINCIDING_METHODS)
        bare = pair_of(bare_machine(mechanism))
        for one, methods in zip((*serial_pairs[:3], bare), (POSED, asked, POSED, asked), strict=True):
            yield from ((one, sample, methods) for sample in few(coinciding(one.machine), A_FEW))


def test_every_statement_of_the_shared_objects_runs() -> None:
    kinds = product(test_shared_matrices.ORDERS, (72, 36))
    libraries = [compiled_shared(), *(test_shared_matrices.library(*kind) for kind in kinds)]
    libraries += [test_shared_matrices.misbehaving(name) for name in test_shared_matrices.BROKEN]
    scara, arm = (next(m for m in MECHANISMS if m.block_name == name) for name in OF_THE_BASE)
    for mechanism in (scara, arm):
        libraries += [compiled(mechanism), compiled(mechanism, matrix_size=36)]
        libraries.append(test_initialise.without_index_checks(mechanism))
    five_axes = next(m for m in MECHANISMS if m.block_name == OF_A_DIRECTION)
    straight = [next(m for m in MECHANISMS if m.block_name == name) for name in WITHOUT_TURN]
    libraries += [test_blocks_alone.geared(scara), compiled(five_axes), *map(compiled, straight)]
    asked = {*test_shared_line.OF_STATEMENTS, *test_shared_teach.OF_STATEMENTS}
    libraries += [compiled(named(name)) for name in sorted(asked)]
    libraries.append(test_self_test.with_faults(scara))
    statements = Statements(shared_texts(), libraries)
    with statements.watched():
        for mechanism in (scara, arm):
            pairs = pairs_of(mechanism)
            test_axis_settings.test_initialize_refuses_what_the_drives_exclude(mechanism)
            test_axis_settings.test_what_is_refused_changes_nothing(mechanism)
            test_initialise.test_limits_are_in_order(pairs, 10.0, 10.0)
            test_initialise.test_a_matrix_of_another_size_is_refused(pairs, 36)
            test_initialise.test_a_configuration_that_is_too_small_is_refused(pairs)
            test_garbage.test_garbage_in_one_number(pairs)
            test_garbage.test_what_is_no_rotation(pairs)
            test_initialise.test_no_method_works(pairs, test_initialise.fresh)
            for one in pairs[:4]:
                for sample in (*few(one.regular, FEW), *few(one.grid, A_FEW)):
                    compare_all(one, sample)
        test_blocks_alone.test_a_gear_of_one_turn_changes_nothing()
        for mechanism in (scara, five_axes, *straight):
            test_blocks_alone.test_every_block_knows_its_orientation(pairs_of(mechanism))
            test_blocks_alone.test_a_further_method_answers_or_is_impossible(pairs_of(mechanism))
            compare_all(pairs_of(mechanism)[0], pairs_of(mechanism)[0].regular[0])
        directed = pairs_of(five_axes)[1]
        provoke(directed, directed.regular[0])
        test_self_test.every_statement_of_the_base(libraries[-1], scara)
        test_shared_line.every_statement()
        test_shared_teach.every_statement()
        for size in (6, 18):
            test_shared_matrices.test_solve(size)
        for size in (3, 8):
            test_shared_matrices.test_solve_where_nothing_solves(np.ones((size, size)))
        for test in (*vars(test_shared_functions).values(), *vars(test_shared_matrices).values()):
            if getattr(test, "__name__", "").startswith("test_") and not hasattr(test, "pytestmark"):
                test()
        for order in test_shared_matrices.ORDERS:
            test_shared_matrices.test_the_order_is_found(order)
            test_shared_matrices.test_read_and_write(order)
        for name in test_shared_matrices.BROKEN:
            test_shared_matrices.test_no_order_where_the_library_behaves_otherwise(name)
        test_shared_matrices.test_no_order_where_the_size_differs(36)
        test_shared_matrices.test_nothing_is_touched_where_the_matrix_is_not_known(36, "Rows")
    assert [str(place) for place in statements.left_out() if not is_head(str(place))] == []


def is_head(place: str) -> bool:
    """Whether a place is the first line of a function block, which is no statement."""
    file, line = place.rsplit(":", 1)
    return shared_texts()[file].split("\n")[int(line) - 1].startswith("FUNCTION_BLOCK")


def left_out(mechanism: Mechanism, statements: Statements) -> list[str]:
    """The statements of a unit that did not run, but for those that no input reaches."""
    lines, dead = lines_of(mechanism)
    missing = {place.line for place in statements.left_out()} - dead
    return [f"{line}: {lines[line - 1].strip()}" for line in sorted(missing)]


@cache
def lines_of(mechanism: Mechanism) -> tuple[list[str], set[int]]:
    """The lines of a unit, and the numbers of those that no input reaches or that are no statement."""
    lines = text_of(mechanism).split("\n")
    heads = {number for number, line in enumerate(lines, 1) if line.startswith("FUNCTION_BLOCK")}
    return lines, unreachable(mechanism, lines) | heads


def few(samples: tuple[Sample, ...], count: int) -> tuple[Sample, ...]:
    """About that many of some samples, from all over them."""
    return samples[:: max(1, len(samples) // count)]


def libraries(mechanism: Mechanism) -> list[Library]:
    """The unit, as the tests compile it."""
    found = [compiled(mechanism), compiled(mechanism, matrix_size=36)]
    if len(softkin.catalogue()[mechanism.name].CONFIGURATION) > 1:
        found.append(test_initialise.without_index_checks(mechanism))
    return found


def compare_all(one: Pair, sample: Sample, methods: Collection[str] = COMPARISONS.keys()) -> None:
    """Every one of these methods that the block has answers as Python at a sample."""
    for method, compare in COMPARISONS.items():
        if method in methods and method.lower() in one.controller.methods:
            compare(one, sample)


def asked_of_every_block(pairs: tuple[Pair, ...]) -> Iterator[Callable[[], None]]:
    """What the comparisons leave out of any machine: refusals, and the other blocks. Each is a test of its own."""
    yield partial(test_blocks_alone.test_the_number_of_axes, pairs)
    yield partial(test_blocks_alone.test_calling_the_block_itself_does_nothing, pairs)
    yield partial(test_initialise.test_no_method_works, pairs, test_initialise.fresh)
    yield partial(test_initialise.test_limits_are_in_order, pairs, 10.0, 10.0)
    yield partial(test_initialise.test_a_matrix_of_another_size_is_refused, pairs, 36)
    yield partial(test_initialise.test_a_configuration_that_is_too_small_is_refused, pairs)
    yield partial(test_garbage.test_what_is_no_rotation, pairs)
    if pairs[0].mechanism in test_configuration_blocks.CONFIGURABLE:
        yield partial(test_configuration_blocks.test_what_is_set_is_read, pairs[1])
    yield partial(test_limits.test_a_turn_that_refuses_is_told_with_the_one_inside, pairs)
    yield partial(test_initialise.test_every_parameter_is_checked, pairs[-1:])
    yield partial(test_limits.test_every_limit_refuses_alone, pairs)
    yield partial(test_garbage.test_garbage_in_one_number, pairs)


def the_tests(mechanism: Mechanism, serial_pairs: tuple[Pair, ...]) -> Iterator[Callable[[], None]]:
    """The same, and what a serial machine is asked besides."""
    yield partial(test_garbage.test_a_pose_that_cannot_be_assembled, serial_pairs)
    if mechanism.constraints:
        yield test_initialise.test_the_coupling_is_given_once
    yield partial(test_singular_poses.test_a_point_on_the_axis_of_a_link_cannot_be_aimed, serial_pairs[:3])
    yield partial(test_singular_poses.test_a_point_beside_the_first_axis_of_a_stretched_arm, serial_pairs[:3])
    yield partial(test_singular_poses.test_a_point_far_off_the_flange_is_out_of_reach, serial_pairs[:3])
    if mechanism.name in test_singular_poses.OF_TWO_LINKS:
        yield partial(test_singular_poses.test_a_point_inside_the_shortest_reach, mechanism.name)
    yield from asked_of_every_block(serial_pairs)


def unreachable(mechanism: Mechanism, lines: list[str]) -> set[int]:
    """The lines that no input reaches: an axis whose closure allows only an interval always has limits, a divisor that
    has been refused is not replaced, and an inverse without axes has nothing to refuse, and so no reason.
    """
    keys = [capitalized(joint.key) for joint in mechanism.joints if joint.domain is not None]
    dead = {
        f"{word}{key} := {value};" for key in keys for word, value in (("lowest", "-1.0E12"), ("highest", "1.0E12"))
    }
    found = {number for number, line in enumerate(lines, 1) if line.strip() in dead}
    if not mechanism.joints:
        start = next(number for number, line in enumerate(lines, 1) if line.startswith("METHOD PROTECTED ReasonOf "))
        end = next(n for n, line in enumerate(lines, 1) if n > start and line.startswith("END_METHOD"))
        found |= set(range(start, end))
    return found | replaced_after_a_refusal(lines)


def replaced_after_a_refusal(lines: list[str]) -> set[int]:
    """The line behind `ELSE` where the same method refuses what the condition does not admit."""
    required: set[str] = set()
    found: set[int] = set()
    for number, line in enumerate(lines):
        if line.startswith("METHOD "):
            required.clear()
        if not line.startswith("IF "):
            continue
        end = next(k for k in range(number, len(lines)) if lines[k].endswith(" THEN"))
        condition = " ".join(part.strip() for part in lines[number : end + 1])[3:-5]
        if condition.startswith("NOT (") and "  RETURN;" in lines[end + 1 : end + 3]:
            required.add(condition[5:-1])
        elif condition in required:
            found.add(lines.index("ELSE", end) + 2)
    return found
