"""Lengths that others compute: LinuxCNC, genhexkins, its default geometry; its own functions gave these numbers."""

import numpy as np
import pytest
import softkin
from numpy.testing import assert_allclose
from softkin import Hexapod

from tests.catalogue.hexapod.machines import machines, rotation
from tests.text.controller import OK
from tests.text.hexapod.blocks import controller

CASES = {
    (0, 0, 20, 0, 0, 0): (29.746680487073, 29.746680487073, 29.746714726168, 29.746363424795, 29.746363424795,
        29.746714726168),
    (2, 1, 22, 5, -3, 10): (31.759871169751, 31.881509190096, 28.585823216412, 33.902245895411, 29.170986025026,
        32.229428923312),
    (-3, 2, 25, -8, 6, -15): (
        32.047073012586, 32.191238992908, 35.261838360772, 32.093952052596, 38.929389073320, 31.114809124200,
    ),
}  # fmt: skip


@pytest.mark.parametrize("pose", CASES)
def test_the_lengths_that_linuxcnc_computes(pose: tuple[float, ...]) -> None:
    robot, turn = machines()["inch"].robot, rotation(*pose[3:])
    axes = robot.inverse((pose[:3], turn))
    assert_allclose(axes, CASES[pose], atol=5e-12)
    frame, configuration = robot.forward(CASES[pose])
    assert configuration == ()
    assert_allclose(frame.position, pose[:3], atol=2e-11)  # the published lengths have twelve decimals
    assert_allclose(frame.rotation, turn, atol=2e-12)
    status, (position, rows, _) = controller("inch").forward(CASES[pose])
    assert status == OK
    assert_allclose(position, pose[:3], atol=2e-11)
    assert_allclose(rows, turn, atol=2e-12)


def test_the_catalogue_knows_it() -> None:
    """The hexapod is in the catalogue, with three rotations and a square Jacobian."""
    assert softkin.catalogue()["Kin_Hexapod"] is Hexapod
    assert machines()["nominal"].robot.orientation_image().freedom == "three"
    assert np.shape(machines()["nominal"].robot.jacobian((650.0,) * 6)) == (6, 6)
