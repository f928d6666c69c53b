"""The base block: the methods that no geometry changes, and those that every geometry supplies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from jinja2 import Environment

from derive.emit.softmotion.layout import tidy
from derive.emit.st.contract import Contract, Signature
from derive.emit.st.layout import with_gathered

_OWN = ("InitializeReason", "Jacobian", "Margins", "AxisVelocities")
_OF_INTERFACES = (
    "Initialize",
    "IsInitialized",
    "GetKinematicsName",
    "GetAxisProperties",
    "AxisSettings",
    "IsSingularity",
    "GetConfigurationDataSize",
    "GetDefaultConfigurationData",
    "CPConnectible",
    "ActivateAutomaticRotaryPeriods",
    "IsConfigSingular",
    "GetPeriods",
)
INHERITED = frozenset((*_OWN, *_OF_INTERFACES))
"""The public methods that no geometry changes."""


BASE_VARIABLES = ("DEGREE", "RADIAN", "initialized", "refusal", "matrixOrder", "checkLimits", "warningDistance", "axes")
"""The instance variables of the base block."""


@dataclass(frozen=True)
class Method:
    """A method as text: its declaration with parameters, and its local variables with the statements."""

    head: str
    text: str


def base_text(contract: Contract, templates: Environment) -> str:
    """The text of the base block. It lacks the methods of interfaces that the profile leaves out."""
    methods = [
        _method(signature, _template(signature, contract), contract, templates) for signature in _signatures(contract)
    ]
    return templates.get_template("base/block.st.j2").render(contract.spelling, methods=methods)


def _signatures(contract: Contract) -> Iterator[Signature]:
    known = {name for i in contract.interfaces.values() if i.name not in contract.omits for name in i.methods}
    for name in _OF_INTERFACES:
        if name in known:
            yield contract.signatures[name]
    for name in _OWN:
        yield contract.own[name]
    yield from contract.supplied.values()


def _template(signature: Signature, contract: Contract) -> str:
    return "Supplied" if signature.name in contract.supplied else signature.name


def _method(signature: Signature, template: str, contract: Contract, templates: Environment) -> Method:
    text = templates.get_template(f"base/{template}.st.j2").render(contract.spelling, method=signature.name)
    return Method(signature.head(), with_gathered(tidy(text)))
