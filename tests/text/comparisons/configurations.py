"""The bytes of CONFIGDATA: branches and turns."""

from collections.abc import Iterable

from tests.text.pairs import Pair
from tests.text.samples import Bytes, Sample

BYTES = 32
"""The bytes of CONFIGDATA in the stand-in for the library."""


def padded(found: Iterable[int]) -> Bytes:
    """Signed configuration bytes as all bytes of CONFIGDATA: those without a meaning are 0."""
    given = tuple(byte % 256 for byte in found)
    return given + (0,) * (BYTES - len(given))


def signed(byte: int) -> int:
    """A byte as a signed number."""
    return byte - 256 if byte > 127 else byte


def configuration_size(pair: Pair, sample: Sample) -> None:
    assert pair.controller.block.call("GetConfigurationDataSize") == len(pair.robot.CONFIGURATION) == len(sample.data)


def default_configuration(pair: Pair, sample: Sample) -> None:
    found = pair.controller.configuration(sample.data)
    assert pair.controller.block.call("GetDefaultConfigurationData", cd=found) is True
    assert tuple(found.abyData) == padded(pair.robot.DEFAULT_CONFIGURATION)


def connectible(pair: Pair, sample: Sample) -> None:
    """By the branch bytes alone."""
    branches = pair.robot.BRANCHES
    others = sample.data[:branches] + tuple(255 - byte for byte in sample.data[branches:])
    changed = tuple(255 - byte for byte in sample.data[:branches]) + sample.data[branches:]
    for data, expected in ((sample.data, True), (others, True), (changed, branches == 0)):
        given = {"cd1": pair.controller.configuration(sample.data), "cd2": pair.controller.configuration(data)}
        assert pair.controller.block.call("CPConnectible", **given) is expected


def automatic_periods(pair: Pair, sample: Sample) -> None:
    """The period bytes are 0, and all others are copied."""
    source, found = pair.controller.configuration(sample.data), pair.controller.configuration(())
    expected = list(source.abyData)
    expected[pair.robot.BRANCHES : len(sample.data)] = [0] * len(pair.robot.PERIOD_AXES)
    pair.controller.block.call("ActivateAutomaticRotaryPeriods", cdDst=found, cdSrc=source)
    assert found.abyData == expected


def singular_configuration(pair: Pair, sample: Sample) -> None:
    """IsConfigSingular tells where a branch byte says that branches coincide."""
    branches = pair.robot.BRANCHES
    for byte in range(5):
        data = (byte,) * branches + (3,) * (len(sample.data) - branches)
        given = pair.controller.configuration(data)
        assert pair.controller.block.call("IsConfigSingular", cd=given) is (byte == 3 and branches > 0)


def periods(pair: Pair, sample: Sample) -> None:
    """By axis, signed; 0 for an axis without a period."""
    found = [99] * 6
    pair.controller.block.call("GetPeriods", cd=pair.controller.configuration(sample.data), aPeriods=found)
    expected = [0] * 6
    for axis, byte in zip(pair.robot.PERIOD_AXES, sample.data[pair.robot.BRANCHES :], strict=True):
        expected[axis] = signed(byte)
    assert found == expected
