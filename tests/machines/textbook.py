"""How a machine of the tests is described, in one line where it is a chain."""

from derive.frames import Chain
from derive.mechanism import Branch, Joint, Mechanism, Parameter, Task, Vendor


def read_by(chain: Chain, stock: tuple[Joint | Parameter, ...]) -> dict[str, tuple[Joint | Parameter, ...]]:
    """The joints and the parameters of a stock that a chain reads, in its order: two fields of a description."""
    named = {quantity.symbol: quantity for quantity in stock}
    assert len(named) == len(stock), "two quantities of the stock have one name"
    read = [symbol for factor in chain.factors for symbol in sorted(factor.amount.free_symbols, key=str)]
    found = [named[symbol] for symbol in dict.fromkeys(read) if symbol in named]
    kinds = {"joints": Joint, "parameters": Parameter}
    return {name: tuple(one for one in found if isinstance(one, kind)) for name, kind in kinds.items()}


def textbook(
    stock: tuple[Joint | Parameter, ...],
    name: str,
    chain: Chain,
    task: Task,
    branches: tuple[Branch, ...] = (),
    **details: object,
) -> Mechanism:
    """A chain that is in no catalogue: its joints and its parameters are those of the stock that the chain reads, in
    that order. details: other fields of the description, or these where the order is another one.
    """
    stated = {"family": "articulated", "offset_interface": False, **read_by(chain, stock), **details}
    return Mechanism(
        name=f"Kin_{name}",
        vendor=Vendor.TEXTBOOK,
        source="the tests",
        summary="A machine that is in no catalogue.",
        chain=chain,
        task=task,
        branches=branches,
        **stated,  # type: ignore[arg-type]
    )
