"""How a machine of the tests is described, in one line where it is a chain."""

from derive.frames import Chain
from derive.mechanism import Branch, Joint, Mechanism, Parameter, Task, Vendor


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
    named = {quantity.symbol: quantity for quantity in stock}
    assert len(named) == len(stock), "two quantities of the stock have one name"
    read = [symbol for factor in chain.factors for symbol in sorted(factor.amount.free_symbols, key=str)]
    found = [named[symbol] for symbol in dict.fromkeys(read) if symbol in named]
    stated = {
        "family": "articulated",
        "offset_interface": False,
        "joints": tuple(one for one in found if isinstance(one, Joint)),
        "parameters": tuple(one for one in found if isinstance(one, Parameter)),
        **details,
    }
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
