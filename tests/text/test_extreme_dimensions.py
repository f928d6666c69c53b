"""Whatever the dimensions are, a block ends in a status: a division by zero would stop the controller."""

import softkin
from softkin import KinematicsError

from tests.catalogue.extreme import extreme_dimensions
from tests.text.controller import NOT_INITIALIZED, OK, Controller
from tests.text.pairs import Pair

MACHINES = 8
IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def test_every_call_ends(pairs: tuple[Pair, ...]) -> None:
    """Initialize refuses what Python refuses, and every call after it answers a status."""
    mechanism = pairs[0].mechanism
    made = softkin.catalogue()[mechanism.name]
    names = {p.name for p in made.PARAMETERS}
    for given in extreme_dimensions(mechanism, MACHINES):
        controller = Controller(pairs[0].library, mechanism)
        try:
            made(**{name: value for name, value in given.items() if name in names})
            expected = OK
        except KinematicsError:
            expected = NOT_INITIALIZED
        assert controller.initialise(given) == expected
        axes = [10.0 * (k + 1) for k in range(len(made.AXES))]
        status, pose = controller.forward(axes)
        position, rows = pose[:2] if status == OK else ((30.0, -20.0, 10.0), IDENTITY)
        controller.inverse(position, rows, made.DEFAULT_CONFIGURATION, axes)
