"""Points at an offset from the flange, and the configuration of each."""

from collections.abc import Iterable

from tests.text.comparisons.configurations import padded
from tests.text.controller import OK, asked, assert_same
from tests.text.pairs import Pair
from tests.text.samples import Sample


def configuration_offset(pair: Pair, sample: Sample) -> None:
    """All automatic where there is no pose: the method has no status."""
    for offset in ((0.0, 0.0, 0.0), sample.offset):
        _, found = asked(pair.robot.configuration_offset, sample.axes, offset)
        expected = padded(found or ())
        assert pair.controller.configuration_offset(sample.axes, offset) == expected, f"{pair} {sample}"


def inverse_offset(pair: Pair, sample: Sample) -> None:
    """CartesianToAxes_Offset answers as Python: branches named and open, references near and far, and out of reach."""
    robot, far = pair.robot, sample.reference
    if asked(robot.forward, sample.axes)[0] != OK:
        return
    for offset in ((0.0, 0.0, 0.0), sample.offset):
        place = point_at(pair, sample, offset)
        own = robot.configuration_offset(sample.axes, offset)
        opened = (0,) * len(own)
        for point, configuration, reference in (
            (place, own, sample.axes),
            (place, own, far),
            (place, opened, sample.axes),
            (place, opened, far),
            (place, sample.data, far),
            (tuple(2.0 * v for v in place), robot.DEFAULT_CONFIGURATION, far),
        ):
            status, answer = asked(robot.inverse_offset, point, offset, configuration, reference)
            expected = answer + (0.0,) * (6 - len(answer)) if status == OK else None
            found = pair.controller.inverse_offset(point, offset, configuration, reference)
            assert_same(found, (status, expected), pair, point, offset, configuration, reference)


def point_at(pair: Pair, sample: Sample, offset: Iterable[float]) -> tuple[float, ...]:
    """Where a point of the flange is."""
    (position, rotation), _ = pair.robot.forward(sample.axes)
    arm = tuple(offset)
    return tuple(
        p + sum(r * o for r, o in zip(row, arm, strict=True)) for p, row in zip(position, rotation, strict=True)
    )
