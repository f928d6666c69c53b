"""Every method of every emitted block is executed, and answers what the Python package answers."""

import pytest

from derive.description.mechanism import Mechanism
from tests.text.comparisons import POSELESS
from tests.text.loops.machines import LOOPS, Loop
from tests.text.pairs import POSITION_KINEMATICS, comparisons_of, pairs_of
from tests.text.units import compiled, public_methods

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
    """Every mechanism with rods is compared."""
    assert len(LOOPS) == 17


@pytest.mark.parametrize("mechanism", POSITION_KINEMATICS, ids=lambda m: m.name)
def test_every_method_is_here(mechanism: Mechanism) -> None:
    """Every public method in the text of a block is compared."""
    library = compiled(mechanism)
    block, base = library.objects[mechanism.block_name], library.objects["Softkin_Kinematics"]
    own, inherited = ([m.name for m in b.methods if m.access == "PUBLIC"] for b in (block, base))
    found = public_methods(mechanism)
    assert list(found[: len(own)]) == own and set(found[len(own) :]) <= set(inherited)
    assert {"Initialize", "Jacobian", "AxisVelocities"} <= set(found)


@pytest.mark.slow(*DEAR)
@pytest.mark.long("Hexapod", "P2C_Type1.CartesianToAxes", "Pos_RRR.CartesianToAxes", "ToAxes_Offset", "Diagnose")
@pytest.mark.parametrize(("mechanism", "method"), METHODS, ids=[f"{m.block_name}.{method}" for m, method in METHODS])
def test_a_method_answers_as_in_python(mechanism: Mechanism, method: str) -> None:
    """A method of the block answers as the Python package does."""
    compare = comparisons_of(mechanism)[method]
    for pair in pairs_of(mechanism):
        regular = pair.regular[:: 2 if isinstance(pair, Loop) else 1]  # which has many, for its limits
        for sample in regular[: 3 if method in POSELESS else None]:
            compare(pair, sample)
        for sample in pair.any if isinstance(pair, Loop) and method in EVERYWHERE else ():
            compare(pair, sample)
