"""Every statement of the emitted orientation kinematics is executed by the tests: none is dead, none untried."""

import pytest

from derive.description.mechanism import Mechanism
from tests.mechanisms import limit_names
from tests.text import test_axis_settings, test_configuration_blocks, test_initialise
from tests.text.controller import BAD_INPUT, NOT_INITIALIZED
from tests.text.coupling import test_structured_text as tried
from tests.text.coupling import test_tools
from tests.text.coupling.blocks import ORIENTATIONS, OrientationController, orientation_pairs_of
from tests.text.other_turns import check_other_turns
from tests.text.reasons import provoke
from tests.text.samples import Sample
from tests.text.statements import Statements
from tests.text.test_every_statement import left_out, libraries
from tests.text.units import compiled, file_of

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("mechanism", ORIENTATIONS, ids=lambda m: m.name)
def test_every_statement_runs(mechanism: Mechanism) -> None:
    pairs = orientation_pairs_of(mechanism)
    statements = Statements([file_of(mechanism)], libraries(mechanism))
    with statements.watched():
        for one in pairs:
            for sample in one.regular[:2]:
                for _, method in (m for m in tried.METHODS if m[0] is mechanism):
                    tried.COMPARISONS[method](one, sample)
            if one.robot.AXES:
                _refused_by_forward_kinematics(one, one.regular[0])
            _refused_by_limits(one, one.regular[0])
            check_other_turns(one, one.regular[0])
            provoke(one, one.regular[0])
        for freedom in tried.CARRIERS:
            tried.test_garbage_and_no_initialisation(mechanism, freedom)
        test_axis_settings.every_statement_of_the_settings(mechanism)
        tried.test_what_every_block_is_asked(mechanism)
        tried.test_a_tool_that_points_the_opposite_way(mechanism)
        test_tools.test_what_is_no_rotation_is_refused(mechanism)
        test_initialise.test_every_parameter_is_checked(pairs[-1:])
        test_initialise.test_limits_are_in_order(pairs, 10.0, 10.0)
        small = OrientationController(compiled(mechanism, matrix_size=36), mechanism)
        assert small.initialise(pairs[0].robot.parameters) == NOT_INITIALIZED
        if pairs[0].robot.CONFIGURATION:
            test_initialise.test_a_configuration_that_is_too_small_is_refused(pairs)
            test_configuration_blocks.test_what_is_set_is_read(pairs[0])
    assert left_out(mechanism, statements) == []


def _refused_by_forward_kinematics(one: tried.OrientationPair, sample: Sample) -> None:
    """An axis whose limit is the largest input may stand beyond it by the tolerance of limits."""
    axes = (1e9 + 1.0 - 2_777_778 * 360.0, *sample.axes[1:])
    first, (frame, named) = one.robot.AXES[0].name.lower(), one.robot.forward(axes)
    block = OrientationController(one.library, one.mechanism)
    unlimited = {**one.robot.parameters, **dict.fromkeys(limit_names(one.mechanism), 0.0)}
    block.initialise({**unlimited, f"lower_{first}": -1e9, f"upper_{first}": 1e9})
    branches, reference = one.robot.BRANCHES, (1e9, *sample.axes[1:])
    data = (*named[:branches], *[0] * (len(named) - branches))
    status, _ = block.end_point(frame.rotation, tried.Image("zero"), data, reference)
    assert status == BAD_INPUT


def _refused_by_limits(one: tried.OrientationPair, sample: Sample) -> None:
    """Every axis below its lower limit, and above its upper one, on a branch that is named and on any."""
    closed = one.robot.forward(sample.axes)[1]
    for axis, value in zip(one.robot.AXES, sample.axes, strict=True):
        for low, high in ((value + 5.0, value + 50.0), (value - 50.0, value - 5.0)):
            block = OrientationController(one.library, one.mechanism)
            limits = {f"lower_{axis.name.lower()}": low, f"upper_{axis.name.lower()}": high}
            robot = type(one.robot)(**{**one.robot.parameters, **limits})
            block.initialise(robot.parameters)
            for data in (closed, (0,) * len(closed)):
                reason, missing = block.diagnose((0.0, 0.0, 0.0), sample.rotation, data, sample.axes)
                found = robot.diagnose(((0.0, 0.0, 0.0), sample.rotation), data, sample.axes)
                assert (reason, missing) == (found.reason, pytest.approx(found.missing, rel=1e-9, abs=1e-9))
