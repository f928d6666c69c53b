"""Blocks alone: every method, also inherited, and what was worked out by hand."""

import numpy as np
import pytest

from bench.blocks import FOLDER, KINDS, Kind, measured
from derive.description.mechanism import Mechanism
from derive.emit.softmotion.base import INHERITED
from tests.catalogue.coupling.parts import ORIENTATIONS
from tests.harness.library import Library
from tests.text.any_method import call_of, methods_of
from tests.text.comparisons import POSELESS
from tests.text.controller import IMPOSSIBLE, OK, Controller
from tests.text.loops.machines import LOOPS, Loop
from tests.text.pairs import POSITION_KINEMATICS, Pair, comparisons_of, pairs_of
from tests.text.serial_pairs import MECHANISMS, SerialPair, serial_pairs_of
from tests.text.units import compiled, compiled_text, file_of, public_methods, text_of


def test_the_number_of_axes(serial_pairs: tuple[SerialPair, ...]) -> None:
    for one in serial_pairs:
        assert one.controller.block.get("NumAxes") == len(one.mechanism.joints)


def test_calling_the_block_itself_does_nothing(serial_pairs: tuple[SerialPair, ...]) -> None:
    one = serial_pairs[1]
    fields = [v.name for section in one.library.objects[one.mechanism.block_name].sections for v in section.variables]
    before = [getattr(one.controller.block, name) for name in fields]
    one.controller.block()
    assert [getattr(one.controller.block, name) for name in fields] == before


def geared(mechanism: Mechanism) -> Library:
    """A unit whose first axis has a gear, of one turn per turn."""
    text, place = text_of(mechanism), "layout.iRows :="
    assert place in text
    return compiled_text(file_of(mechanism), text.replace(place, f"layout.aGeared[0] := TRUE;\n{place}", 1))


def test_a_gear_of_one_turn_changes_nothing() -> None:
    """The turns of a joint behind a gear are counted by the base block; with one turn per turn they are those of the
    axis.
    """
    mechanism = next(m for m in MECHANISMS if m.name == "Kin_Scara4_ZCcoupled_Type1")
    one = serial_pairs_of(mechanism)[0]
    other = Controller(geared(mechanism), mechanism)
    assert other.initialise(one.robot.parameters) == OK
    for sample in one.regular[:10]:
        axes = [value + 360.0 * k for k, value in enumerate(sample.axes)]
        assert other.forward(axes) == one.controller.forward(axes)


METHODS = [(mechanism, method) for mechanism in POSITION_KINEMATICS for method in public_methods(mechanism)]
"""Every method that stands in the emitted text. That private ones run is shown statement by statement elsewhere."""
ITERATED = ("Hexapod", "Hexaglide", "3RRR", "ThreeParallel")
DEAR = tuple(f"{name}.{method}" for name in ITERATED for method in ("CartesianToAxes", "Diagnose"))
"""What takes long: inverse kinematics of machines that iterate."""
EVERYWHERE = (
    "AxesToCartesian", "CartesianToAxes", "AxesToOrientation", "IsSingularity", "Jacobian",
    "AxesToConfiguration_Offset", "CartesianToAxes_Offset",
)  # fmt: skip
"""Methods of loops that are asked for axis values at which no loop closes as well."""


def test_every_loop_is_here() -> None:
    assert len(LOOPS) == 19


@pytest.mark.parametrize("mechanism", (*POSITION_KINEMATICS, *ORIENTATIONS), ids=lambda m: m.name)
def test_every_method_is_here(mechanism: Mechanism) -> None:
    library = compiled(mechanism)
    block, base = library.objects[mechanism.block_name], library.objects["Softkin_Kinematics"]
    own, inherited = ([m.name for m in b.methods if m.access == "PUBLIC"] for b in (block, base))
    found = public_methods(mechanism)
    assert list(found[: len(own)]) == own and set(found[len(own) :]) <= set(inherited)
    assert {"Initialize", "Jacobian", "AxisVelocities"} <= set(found) or mechanism in ORIENTATIONS


@pytest.mark.slow(*DEAR)
@pytest.mark.long("Hexapod", "P2C_Type1.CartesianToAxes", "Pos_RRR.CartesianToAxes", "ToAxes_Offset", "Diagnose")
@pytest.mark.parametrize(("mechanism", "method"), METHODS, ids=[f"{m.block_name}.{method}" for m, method in METHODS])
def test_a_method_answers_as_in_python(mechanism: Mechanism, method: str) -> None:
    compare = comparisons_of(mechanism)[method]
    for pair in pairs_of(mechanism):
        regular = pair.regular[:: 2 if isinstance(pair, Loop) else 1]  # which has many, for its limits
        for sample in regular[: 3 if method in POSELESS else None]:
            compare(pair, sample)
        for sample in pair.any if isinstance(pair, Loop) and method in EVERYWHERE else ():
            compare(pair, sample)


def further_methods(controller: Controller) -> list[str]:
    """The public methods of the base that no interface of the block has."""
    known = {"Initialize", *methods_of(controller)}
    return sorted(INHERITED - known)


@pytest.mark.long("Hexa", "3RRR", "P2C", "Pos_RRR")
def test_a_further_method_answers_or_is_impossible(pairs: tuple[Pair, ...]) -> None:
    """What forward kinematics tells is answered; what a flange does not do is impossible, and writes nothing."""
    one = pairs[0]
    for method in further_methods(one.controller):
        call = call_of(one, one.controller, method, one.regular[0])
        before = call.state()
        result, after = call.run()
        if call.has_status:
            assert result in (OK, IMPOSSIBLE), method
            assert result == OK or after == before, method


def test_every_block_knows_its_orientation(pairs: tuple[Pair, ...]) -> None:
    for one in pairs[:2]:
        for sample in one.regular[:3]:
            status, found = one.controller.orientation(sample.axes)
            assert status == OK
            np.testing.assert_allclose(found, one.controller.forward(sample.axes)[1][1], rtol=0, atol=1e-12)


RATIO = 1.3
"""The algebra to that by hand, at most."""
CALLS = 30
"""Calls of functions a solution, at most."""
ROUNDING = 1e-13


@pytest.mark.parametrize("kind", KINDS, ids=lambda k: k.name)
def test_the_text_by_hand_is_right(kind: Kind) -> None:
    """Forward kinematics, which the closure has proven, leads from its answers back to the pose, on its branch."""
    found = measured(kind)
    assert found.poses >= 40
    assert found.missed < ROUNDING


@pytest.mark.parametrize("kind", KINDS, ids=lambda k: k.name)
def test_a_call_costs_no_more_than_promised(kind: Kind) -> None:
    """The whole call, all calls of functions, and the algebra beside that by hand."""
    found = measured(kind)
    assert found.call <= kind.most
    assert found.calls <= CALLS
    assert found.ratio <= RATIO
    assert min(found.by_hand) > 30, "something was counted"


def test_every_text_by_hand_is_measured() -> None:
    assert {path.stem for path in FOLDER.glob("*.st")} == {kind.by_hand for kind in KINDS}
