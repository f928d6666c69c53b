"""Every method of the emitted orientation kinematics is executed, in both orders of the matrix, and answers as Python
does."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from derive.description.mechanism import Mechanism, Turning
from tests.catalogue.coupling.determined import is_determined
from tests.catalogue.coupling.parts import EVERYTHING, position_part
from tests.orthonormal import rodrigues, rows
from tests.text import test_blocks_alone, test_garbage, test_initialise
from tests.text.comparisons import COMPARISONS as COMMON
from tests.text.comparisons.initialization import initialize
from tests.text.controller import BAD_INPUT, IMPOSSIBLE, OK, UNREACHABLE, asked, assert_same, is_close
from tests.text.coupling.blocks import ORIENTATIONS, Image, OrientationPair, orientation_pairs_of
from tests.text.samples import HALF_TURN, NO_TURN, Rows, Sample, tilted
from tests.text.units import public_methods

INVALID = "SMC_TRAFO_INVALID_COUPLING"
GARBAGE = (math.nan, math.inf, -math.inf, 1e300, 1.1e9)
SKEWED: Rows = ((1.0, 0.01, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
CARRIERS = {"zero": "Kin_Gantry3", "one": "Kin_Scara2_Z", "three": "Kin_Pos_RRR"}
ORDERS = ("rows", "columns")


def images(rng: np.random.Generator) -> Iterator[tuple[Image, Callable[[], np.ndarray]]]:
    """Images of flanges, and orientations that such a flange has."""
    still = np.array(tilted(rng))
    yield Image("zero", rows(still)), lambda: still
    yield Image("one"), lambda: _about(np.array((0.0, 0.0, 1.0)), rng)
    down = np.diag((1.0, -1.0, -1.0))
    yield (
        Image("one", rows(down), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)),
        lambda: _about(np.array((0.0, 0.0, 1.0)), rng) @ down,
    )
    base, zero = np.array(tilted(rng))[:, 0], np.array(tilted(rng))
    yield (
        Image("one", rows(zero), tuple(base.tolist()), tuple((zero.T @ base).tolist())),
        lambda: _about(base, rng) @ zero,
    )
    yield Image("three", rows(still)), lambda: np.array(tilted(rng))


def _about(axis: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    return rodrigues(axis, rng.uniform(-np.pi, np.pi))


def compatible(pair: OrientationPair, sample: Sample) -> None:
    """As in Python, and as the equations say of a flange of every kind."""
    rng = np.random.default_rng(31)
    for image, _ in images(rng):
        expected = pair.robot.is_compatible(image.in_python())
        assert pair.controller.is_compatible(image) is expected
    if sample is pair.regular[0]:
        for freedom, carrier in CARRIERS.items():
            assert pair.controller.is_compatible(Image(freedom)) is is_determined(
                position_part(EVERYTHING[carrier]), pair.part
            )


def end_point(pair: OrientationPair, sample: Sample) -> None:
    """Where the equations have the end point, with the flange as it is at axis values that give the
    commanded rotation.
    """
    rng = np.random.default_rng(37)
    place, own = (m[0] for m in pair.part.closure.frames(pair.part.closure.joints(np.array([sample.axes]))))
    configuration = pair.robot.forward(sample.axes)[1]
    _, inside = asked(pair.robot.inverse, ((0.0, 0.0, 0.0), rows(own)), configuration, sample.axes)
    for image, flange in images(rng):
        turned = flange()
        status, found = pair.controller.end_point(rows(turned @ own), image, configuration, sample.axes)
        if not pair.robot.is_compatible(image.in_python()):
            assert status == INVALID
        elif image.freedom == "zero" and inside is None:
            assert status == UNREACHABLE  # beyond the limits
        else:
            assert status == OK and np.abs(np.subtract(found, turned @ place)).max() < 1e-10


def end_point_2(pair: OrientationPair, sample: Sample) -> None:
    """GetPositionFromOrientation2 answers as the method with all arguments does, at the default configuration."""
    rng = np.random.default_rng(41)
    for image, _ in images(rng):
        expected = pair.controller.end_point(sample.rotation, image, pair.robot.DEFAULT_CONFIGURATION, (0.0,) * 6)
        assert_same(pair.controller.end_point_2(sample.rotation, image), expected, pair)
        assert expected[0] in (OK, INVALID, UNREACHABLE)


def end_point_1(pair: OrientationPair, sample: Sample) -> None:
    """As for a flange that stays parallel to the machine."""
    status, axes = asked(pair.robot.inverse, ((0.0, 0.0, 0.0), sample.rotation))
    expected = pair.robot.forward(axes)[0].position if status == OK else None
    assert_same(pair.controller.end_point_1(sample.rotation), (status, expected), pair, sample)


def total(pair: OrientationPair, sample: Sample) -> None:
    """As in Python; and every orientation of both together is in it."""
    rng = np.random.default_rng(43)
    own = pair.part.closure.frames(pair.part.closure.joints(np.array([sample.axes])))[1][0]
    for image, flange in images(rng):
        status, (freedom, zero, base, seen) = pair.controller.total(image)
        assert status == OK
        expected = pair.robot.image_on(image.in_python())
        assert freedom == expected.freedom == _expected_freedom(pair.mechanism.task.turning, image)
        assert_same(zero, expected.rotation, pair)
        if freedom != "three":
            assert_same((base, seen), (expected.base_axis, expected.flange_axis), pair)
        together = flange() @ own
        if freedom == "one":
            assert np.abs(together @ seen - base).max() < 1e-12 and np.abs(np.array(zero) @ seen - base).max() < 1e-12
        elif freedom == "zero":
            assert np.abs(together - zero).max() < 1e-12


def _expected_freedom(turning: Turning, image: Image) -> str:
    along_z = abs(abs(image.flange_axis[2]) - 1.0) < 1e-9
    if turning is Turning.NONE:
        return image.freedom
    if turning is Turning.ABOUT_Z and (image.freedom == "zero" or (image.freedom == "one" and along_z)):
        return "one"
    return "three"


def with_orientation(pair: OrientationPair, sample: Sample) -> None:
    """What is left free once an orientation is programmed, in whose frame, and whether it is chosen here."""
    turning = pair.mechanism.task.turning
    direction = tuple(row[2] for row in sample.rotation)
    z = (0.0, 0.0, 1.0)
    expected, how = {
        Turning.NONE: (("zero", NO_TURN, z, z), ("Flange", False)),
        Turning.ABOUT_Z: (("one", NO_TURN, z, z), ("Flange", True)),
        Turning.DIRECTION: (("one", sample.rotation, direction, z), ("MCS", False)),
        Turning.FULL: (("zero", sample.rotation, direction, z), ("MCS", True)),
    }[turning]
    status, image, found = pair.controller.with_orientation(sample.rotation, Image("one"))
    assert status == OK and is_close(image, expected) and found == how
    status = pair.controller.with_orientation(SKEWED, Image("one"))[0]
    assert status == (BAD_INPUT if turning in (Turning.DIRECTION, Turning.FULL) else OK)


def initialised(pair: OrientationPair, sample: Sample) -> None:
    """Initialize answers as Python; a block without axes is initialised from the start."""
    if pair.mechanism.joints:
        initialize(pair, sample)
    else:
        assert pair.controller.block.call("IsInitialized") and pair.controller.block.call("Initialize") == OK


COMPARISONS = COMMON | {
    "Initialize": initialised,
    "IsInitialized": initialised,
    "IsCompatibleWithPosKin": compatible,
    "GetPositionFromOrientation3": end_point,
    "GetPositionFromOrientation2": end_point_2,
    "GetPositionFromOrientation": end_point_1,
    "GetOrientationImageTotal": total,
    "GetOrientationImageWithOri": with_orientation,
}
METHODS = [(mechanism, method) for mechanism in ORIENTATIONS for method in public_methods(mechanism)]


@pytest.mark.long("IsCompatibleWithPosKin")
@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(("mechanism", "method"), METHODS, ids=[f"{m.block_name}.{method}" for m, method in METHODS])
def test_a_method_answers_as_in_python(mechanism: Mechanism, method: str, order: str) -> None:
    for pair in orientation_pairs_of(mechanism, order):
        for sample in pair.regular:
            COMPARISONS[method](pair, sample)


@pytest.mark.parametrize("mechanism", ORIENTATIONS, ids=lambda m: m.name)
def test_what_every_block_is_asked(mechanism: Mechanism) -> None:
    """The number of its axes, its orientation, and what no interface of it has; it has no offset of its own."""
    pairs = orientation_pairs_of(mechanism)
    test_blocks_alone.test_the_number_of_axes(pairs)
    if mechanism.joints:
        test_blocks_alone.test_every_block_knows_its_orientation(pairs)
        test_blocks_alone.test_a_further_method_answers_or_is_impossible(pairs)
        asked_for = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), pairs[0].robot.DEFAULT_CONFIGURATION, pairs[0].regular[0].axes
        assert pairs[0].controller.inverse_offset(*asked_for)[0] == IMPOSSIBLE


@pytest.mark.parametrize("mechanism", ORIENTATIONS, ids=lambda m: m.name)
def test_the_position_of_a_frame_is_not_read(mechanism: Mechanism) -> None:
    for pair in orientation_pairs_of(mechanism):
        sample = pair.regular[0]
        (_, rotation), configuration = pair.robot.forward(sample.axes)
        expected = pair.controller.inverse((0.0, 0.0, 0.0), rotation, configuration, sample.axes)
        for position in ((math.nan, math.inf, 1e300), (1e9, -5.0, 3.0)):
            assert pair.controller.inverse(position, rotation, configuration, sample.axes) == expected
            assert asked(pair.robot.inverse, (position, rotation), configuration, sample.axes) == asked(
                pair.robot.inverse, ((0.0, 0.0, 0.0), rotation), configuration, sample.axes
            )


@pytest.mark.parametrize("mechanism", ORIENTATIONS, ids=lambda m: m.name)
def test_a_tool_that_points_the_opposite_way(mechanism: Mechanism) -> None:
    """A tool that points exactly the opposite way is refused where the twist about it is ignored."""
    pair = orientation_pairs_of(mechanism)[0]
    refuses = mechanism.task.turning is Turning.ABOUT_Z
    data = pair.robot.DEFAULT_CONFIGURATION
    status, _ = pair.controller.end_point(HALF_TURN, Image("zero"), data, (0.0,) * 6)
    assert status == (UNREACHABLE if refuses else OK)


@pytest.mark.long
@pytest.mark.parametrize("freedom", CARRIERS)
@pytest.mark.parametrize("mechanism", ORIENTATIONS, ids=lambda m: m.name)
def test_garbage_and_no_initialisation(mechanism: Mechanism, freedom: str) -> None:
    """As of every block, on a flange of every kind."""
    pairs = tuple(replace(one, image=Image(freedom)) for one in orientation_pairs_of(mechanism))
    test_garbage.test_garbage_in_one_number(pairs[:1] * 3)
    test_initialise.test_no_method_works(pairs, test_initialise.fresh)
