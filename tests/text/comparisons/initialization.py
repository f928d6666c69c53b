"""Whether a block is initialised, why it is not, and its name."""

from tests.text.controller import NOT_INITIALIZED, OK, Controller, assert_same
from tests.text.pairs import Pair
from tests.text.samples import Sample


def initialize(pair: Pair, sample: Sample) -> None:
    """Fresh, refused without parameters or with the last one, and again accepted."""
    one = Controller(pair.library, pair.mechanism)
    assert not one.block.call("IsInitialized")
    assert one.initialise(pair.robot.parameters) == OK
    assert one.block.call("IsInitialized")
    one.set_inputs({"offset_" + pair.mechanism.joints[0].key: float("nan")})
    assert one.block.call("Initialize") == NOT_INITIALIZED
    assert not one.block.call("IsInitialized")
    assert one.initialise(pair.robot.parameters) == OK
    assert_same(one.forward(sample.axes), pair.controller.forward(sample.axes), pair, sample)


def why_initialize(pair: Pair, sample: Sample) -> None:
    assert pair.controller.block.call("InitializeReason") == ""


def name(pair: Pair, sample: Sample) -> None:
    expected = pair.mechanism.title or pair.mechanism.block_name
    assert pair.controller.block.call("GetKinematicsName") == expected
