"""What blocks and classes say of lengths and of limits that are not given, against what they do."""

import re

import pytest

from derive.description.mechanism import Mechanism, Role
from derive.emit.softmotion.inputs import wanted_name
from derive.kinematics.parameters import machine_parameters
from tests.catalogue.turns.axes import robot_of
from tests.mechanisms import catalogue, limit_names
from tests.text.controller import NOT_INITIALIZED, OK, Controller
from tests.text.units import compiled, text_of
from tests.text.values import PROPERTIES_TYPE, meaningless

MECHANISMS = tuple(m for _, m in catalogue())
LENGTHS = (Role.LENGTH, Role.SIGNED_LENGTH, Role.DISTANCE)


def controller(mechanism: Mechanism, **given: float) -> tuple[Controller, str]:
    """A block with nominal parameters and others, and what Initialize answers."""
    block = Controller(compiled(mechanism), mechanism)
    nominal = {p.name: p.nominal for p in mechanism.parameters}
    return block, block.initialise({**nominal, **given})


@pytest.mark.long("Pos_RRR")
@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda m: m.name)
def test_the_lengths_that_are_named_are_refused_at_0(mechanism: Mechanism) -> None:
    """And no others, but where conditions between several parameters forbid it; where none is named, all may be 0."""
    description = " ".join(text_of(mechanism).split())
    said = re.search(r"A length has no default: Initialize refuses 0 for ([\w, ]+)\.", description)
    named = said.group(1).split(", ") if said else []
    assert ("Initialize refuses" in description.replace("Initialize refuses a home pose", "")) == bool(named)
    assert controller(mechanism)[1] == OK
    for parameter in (p for p in mechanism.parameters if p.role in LENGTHS):
        status = controller(mechanism, **{parameter.name: 0.0})[1]
        if wanted_name(parameter) in named:
            assert status == NOT_INITIALIZED
            named.remove(wanted_name(parameter))
        else:
            assert status == OK or mechanism.constraints or mechanism.is_platform
    assert named == []


@pytest.mark.long("Pos_RRR")
@pytest.mark.parametrize("mechanism", MECHANISMS, ids=lambda m: m.name)
def test_what_limits_an_axis_that_is_given_no_limits_is_said(mechanism: Mechanism) -> None:
    """Where a pitch or the closure limits it, with the numbers, in the input's comment and the Python class."""
    limits = {p.name: p for p in machine_parameters(mechanism) if p.name in limit_names(mechanism)}
    text, meanings = (
        " ".join(text_of(mechanism).replace("//", "").split()),  # a long sentence stands on two lines
        {p.name: p.meaning for p in robot_of(mechanism, _nominal(mechanism)).PARAMETERS},
    )
    block = controller(mechanism)[0]
    for index, joint in enumerate(mechanism.joints):
        properties = meaningless(block.library, PROPERTIES_TYPE)
        block.block.call("GetAxisProperties", props=properties, udiAxis=index)
        found = properties.limits
        for end, value in (("lower", found.dLower), ("upper", found.dUpper)):
            parameter = limits[f"{end}_{joint.key}"]
            assert parameter.meaning in text
            assert meanings[parameter.name] == parameter.meaning
            default = parameter.meaning.partition("both 0: ")[2]
            assert (default == "no limit") == (found.xUnlimited and joint.pitch == 0)
            if not found.xUnlimited:
                assert f"{value:g}" in default or value == 1e9


def _nominal(mechanism: Mechanism) -> dict[str, float]:
    return {p.name: p.nominal for p in mechanism.parameters}
