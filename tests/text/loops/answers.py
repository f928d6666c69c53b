"""What every method of a closed loop must answer: the comparisons of the serial machines, but for free rotations."""

from derive.description.mechanism import Turning
from tests.text.comparisons import COMPARISONS as SERIAL
from tests.text.controller import OK, assert_same
from tests.text.loops.machines import Loop
from tests.text.samples import HALF_TURN, NO_TURN, Sample


def image_with_orientation(loop: Loop, sample: Sample) -> None:
    """All rotations can be had: a space of the one that is asked for. One that turns about z has its headings."""
    if loop.mechanism.task.turning is Turning.ABOUT_Z:
        SERIAL["GetFlangeOrientationImageWithOri"](loop, sample)  # type: ignore[arg-type]
        return
    for rows in (sample.rotation, NO_TURN, HALF_TURN):
        status, (dof, zero, *_) = loop.controller.image_with_orientation(rows)
        assert (status, dof) == (OK, "zero")
        assert_same(zero, rows, loop)


COMPARISONS = SERIAL | {"GetFlangeOrientationImageWithOri": image_with_orientation}
"""By the name of the method."""
