"""How a machine of the tests is described, in one line where it is a chain."""

from derive.frames import Chain
from derive.mechanism import Branch, Joint, Mechanism, Parameter, Task, Vendor


def textbook(
    name: str,
    joints: tuple[Joint, ...],
    chain: Chain,
    parameters: tuple[Parameter, ...],
    task: Task,
    branches: tuple[Branch, ...] = (),
    **details: object,
) -> Mechanism:
    """A chain that is in no catalogue. details: other fields of the description."""
    stated = {"family": "articulated", "offset_interface": False, **details}
    return Mechanism(
        name=f"Kin_{name}",
        vendor=Vendor.TEXTBOOK,
        source="the tests",
        summary="A machine that is in no catalogue.",
        joints=joints,
        parameters=parameters,
        chain=chain,
        task=task,
        branches=branches,
        **stated,  # type: ignore[arg-type]
    )
