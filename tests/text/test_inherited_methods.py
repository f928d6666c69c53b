"""Methods that a block inherits beside those of its interfaces: an answer or "impossible", never "not initialised"."""

import numpy as np
import pytest

from derive.description.mechanism import Mechanism
from derive.emit.softmotion.base import INHERITED
from tests.catalogue.coupling.parts import ORIENTATIONS
from tests.text.any_method import call_of, methods_of
from tests.text.controller import IMPOSSIBLE, OK, Controller
from tests.text.pairs import Pair
from tests.text.units import compiled


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
    """AxesToOrientation is the rotation that AxesToCartesian finds, whatever the interfaces of the block are."""
    for one in pairs[:2]:
        for sample in one.regular[:3]:
            status, found = one.controller.orientation(sample.axes)
            assert status == OK
            np.testing.assert_allclose(found, one.controller.forward(sample.axes)[1][1], rtol=0, atol=1e-12)


@pytest.mark.parametrize("mechanism", [m for m in ORIENTATIONS if m.joints], ids=lambda m: m.name)
def test_orientation_blocks_answer_or_say_impossible(mechanism: Mechanism) -> None:
    """A wrist knows its orientation; it has no offset of its own."""
    library = compiled(mechanism)
    controller = Controller(library, mechanism)
    assert controller.initialise({p.name: p.nominal for p in mechanism.parameters}) == OK
    axes = tuple(10.0 + 7.0 * k for k, _ in enumerate(mechanism.joints))
    assert {"AxesToOrientation", "CartesianToAxes_Offset"} <= set(further_methods(controller))
    status, rotation = controller.orientation(axes)
    assert status == OK
    _, (position, turned, data) = controller.forward(axes)
    np.testing.assert_allclose(rotation, turned, rtol=0, atol=1e-12)
    status, _ = controller.inverse_offset(position, (0.0, 0.0, 0.0), data, axes)
    assert status == IMPOSSIBLE
    assert controller.image_with_orientation(rotation)[0] in (OK, IMPOSSIBLE)
