"""Pages of machines in no catalogue: more axes than a block has, guides, a pitch, one of two solutions alone."""

from functools import cache
from xml.etree import ElementTree as ET

import pytest

from derive.drawing.pose import nominal_machine
from derive.emit.page.names import spelling_of
from derive.emit.page.page import page_of
from derive.kinematics.build import build
from derive.kinematics.kinematics import Kinematics
from derive.report.derived import derived_of
from derive.report.singular_poses import SINGULAR, singular_pose
from tests.machines.collection import MACHINES
from tests.machines.guided import GUIDED
from tests.page.reading import every, parsed, section

pytestmark = pytest.mark.slow

OWN = {name: MACHINES[name] for name in ("rail and arm with two links", "arm with four axes", "arm on a track")}
OWN |= {name: MACHINES[name] for name in ("SCARA that bends to the left alone",)}
OWN |= {name: GUIDED[name] for name in ("Z3 head with slides",)}


@cache
def _kinematics(name: str) -> Kinematics:
    return build(OWN[name])


@cache
def _text(name: str) -> str:
    return page_of(OWN[name], _kinematics(name), has_pictures=False).text


def _words(elements: list[ET.Element]) -> str:
    return " ".join("".join(e.itertext()) for e in elements)


@pytest.mark.parametrize("name", OWN)
def test_the_page_is_whole(name: str) -> None:
    """Every step, every margin, every axis by its name."""
    page, kinematics = parsed(_text(name)), _kinematics(name)
    derived = derived_of(_kinematics(name).solution)
    shown = [s.get("id") for s in every(section(page, "derivation"), "section", "step")]
    steps = [route.steps for route in (*derived.inverse, *([derived.forward] if derived.forward else []))]
    assert len(shown) == sum(map(len, steps)) > 1
    told = [s.get("id") for s in every(section(page, "singularities"), "section")]
    assert told == [f"margin-{m.name}" for m in kinematics.margins]
    rows = ["".join(next(iter(row)).itertext()) for row in every(section(page, "machine"), "tr")]
    assert {j.name for j in kinematics.mechanism.joints} <= set(rows)


def test_a_machine_without_a_block() -> None:
    """Seven axes: no name of a block is told, and the programs are those of Python."""
    text = _text("arm on a track")
    assert "SolveBranch" not in text and "As the Python package computes them" in text
    assert not spelling_of(_kinematics("arm on a track")).places


def test_what_is_special_is_told() -> None:
    """Held axes, the one of two solutions, and what the task does not command."""
    held = _words(section(parsed(_text("rail and arm with two links")), "derivation"))
    assert "held, where the reference has them" in held
    alone = _words(section(parsed(_text("SCARA that bends to the left alone")), "derivation"))
    assert "This machine has one of the two alone: the determinant is negative" in alone
    guided = _words(section(parsed(_text("Z3 head with slides")), "derivation"))
    assert "What the task does not command: x, y, twist" in guided and "guide" in guided


def test_a_singular_pose_of_ones_own() -> None:
    """The elbow of a SCARA that is in no catalogue."""
    name = "SCARA that bends to the left alone"
    machine = nominal_machine(_kinematics(name))
    (margin,) = machine.kinematics.margins
    found = singular_pose(
        machine, derived_of(_kinematics(name).solution), margin.name, tuple(j.nominal for j in OWN[name].joints)
    )
    assert found is not None and found.value <= SINGULAR
    assert min(abs(found.axes[1] % 360.0 - straight) for straight in (0.0, 180.0, 360.0)) < 1e-3
