"""Every statement of the emitted orientation kinematics is executed by the tests: none is dead, none untried."""

import pytest

from derive.description.mechanism import Mechanism
from tests.text import test_axis_settings, test_configuration_blocks, test_initialise, values
from tests.text.controller import NOT_INITIALIZED
from tests.text.coupling import test_structured_text as tried
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
            _limits_and_garbage(one)
        _before_initialize(mechanism)
        test_axis_settings.every_statement_of_the_settings(mechanism)
        tried.test_the_number_of_axes(mechanism)
        tried.test_a_tool_that_points_the_opposite_way(mechanism)
        tried.test_garbage_and_no_initialisation(mechanism)
        small = OrientationController(compiled(mechanism, matrix_size=36), mechanism)
        assert small.initialise(pairs[0].robot.parameters) == NOT_INITIALIZED
        if pairs[0].robot.CONFIGURATION:
            test_initialise.test_a_configuration_that_is_too_small_is_refused(pairs)
            test_configuration_blocks.test_what_is_set_is_read(pairs[0])
    assert left_out(mechanism, statements) == []


def _limits_and_garbage(one: tried.OrientationPair) -> None:
    """Axis values and parameters that are no numbers, limits that are not checked, and a flange that is no rotation."""
    axes = [float("nan")] * len(one.mechanism.joints)
    one.controller.forward(axes)
    one.controller.jacobian(axes)
    one.controller.is_singular(axes)
    sample = one.regular[0]
    data = one.robot.DEFAULT_CONFIGURATION
    for rows in (tried.SKEWED, ((-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))):
        one.controller.inverse((0.0, 0.0, 0.0), rows, data, sample.axes)
        one.controller.end_point(rows, tried.Image("three"), data, sample.axes)
        one.controller.end_point(sample.rotation, tried.Image("zero", rows), data, sample.axes)
        one.controller.total(tried.Image("one", rows))
        one.controller.with_orientation(rows, tried.Image("one"))
    for other in one.regular:  # the turn nearest to the end of all numbers is beyond it for half of them
        one.controller.end_point(other.rotation, tried.Image("zero"), data, [1e9] * len(sample.axes))
    for parameter in one.robot.PARAMETERS:
        for wrong in (float("nan"), 1e12, one.robot.parameters[parameter.name] + 0.5):
            block = OrientationController(one.library, one.mechanism)
            changed = {parameter.name: 0.0 if parameter.kind in ("flag", "sign") else wrong}
            block.initialise({**one.robot.parameters, **changed})
            block.inverse((0.0, 0.0, 0.0), sample.rotation, data, sample.axes)
    _refused_by_limits(one, sample)
    check_other_turns(one, sample)
    provoke(one, sample)


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


def _before_initialize(mechanism: Mechanism) -> None:
    """Every method of a block that is not initialised."""
    pair = orientation_pairs_of(mechanism)[0]
    fresh = OrientationController(pair.library, mechanism)
    sample = pair.regular[0]
    data = pair.robot.DEFAULT_CONFIGURATION
    assert fresh.forward(sample.axes)[0] == fresh.jacobian(sample.axes)[0] == NOT_INITIALIZED
    assert fresh.inverse((0.0, 0.0, 0.0), sample.rotation, data, sample.axes)[0] == NOT_INITIALIZED
    assert fresh.is_singular(sample.axes)
    assert fresh.diagnose((0.0, 0.0, 0.0), sample.rotation, data, sample.axes) == ("not initialized", 0.0)
    properties = values.meaningless(pair.library, values.PROPERTIES_TYPE)
    fresh.block.call("GetAxisProperties", props=properties, udiAxis=0)
    assert properties.limits.xUnlimited
