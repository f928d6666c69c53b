"""Orientations: of the axes, and the images of the flange."""

from derive.description.mechanism import Turning
from tests.text.controller import OK, UNREACHABLE, asked, assert_same
from tests.text.pairs import Pair
from tests.text.samples import HALF_TURN, NO_TURN, Sample


def orientation(pair: Pair, sample: Sample) -> None:
    expected = asked(pair.robot.orientation, sample.axes)
    assert_same(pair.controller.orientation(sample.axes), expected, pair, sample)


def image(pair: Pair, sample: Sample) -> None:
    """The methods without a commanded rotation write the orientations that Python gives."""
    for method in ("GetOrientationImage", "GetFlangeOrientationImageTotal"):
        if method.lower() in pair.controller.methods:
            expected = pair.robot.orientation_image()
            assert_same(pair.controller.image(method), (OK, tuple(expected)), pair)


def image_with_orientation(pair: Pair, sample: Sample) -> None:
    """The projection, as a space of one orientation; refused where the tool points exactly the opposite way.

    A machine that follows the whole rotation, or the tool's direction, gives the rotation itself.
    """
    refusals = []
    whole = pair.mechanism.task.turning in (Turning.DIRECTION, Turning.PITCH, Turning.FULL)
    for rows in (sample.rotation, NO_TURN, HALF_TURN):
        status, projected = (OK, rows) if whole else asked(pair.robot.project, rows)
        expected = None
        if status == OK:
            freedom = "one" if pair.mechanism.task.turning is Turning.DIRECTION else "zero"  # the twist is passive
            expected = (freedom, projected, tuple(row[2] for row in projected), (0.0, 0.0, 1.0))
        assert_same(pair.controller.image_with_orientation(rows), (status, expected), pair, rows)
        refusals += [status] if status != OK else []
    assert refusals == ([] if whole else [UNREACHABLE])
