"""The base block: the methods that no geometry changes, and those that every geometry supplies."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

from jinja2 import Environment

from derive.emit.st.contract import Contract, Signature
from derive.emit.st.layout import tidy, with_gathered
from derive.emit.st.rotation import about_z, followed

_OF_AXES = {
    "Jacobian": "Jacobian", "Margins": "Margins", "AxisVelocities": "AxisMotion", "AxisAccelerations": "AxisMotion",
}  # fmt: skip
"""Methods at values of the axes, and their templates."""
_FROM = {f"{name}From": template for name, template in _OF_AXES.items()}
"""The same, from a pose nearby."""
_OWN = ("InitializeReason", *_OF_AXES, *_FROM, "Diagnose")
_OF_INTERFACES = (
    "Initialize",
    "AxesToCartesian",
    "CartesianToAxes",
    "AxesToOrientation",
    "GetOrientationImage",
    "GetFlangeOrientationImageTotal",
    "GetFlangeOrientationImageWithOri",
    "AxesToConfiguration_Offset",
    "CartesianToAxes_Offset",
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
_COMMENTS = re.compile(r"^ *//.*\n", re.MULTILINE)
INHERITED = frozenset((*_OWN, *_OF_INTERFACES))
"""The public methods that no geometry changes."""


BASE_VARIABLES = (
    "DEGREE",
    "RADIAN",
    "initialized",
    "refusal",
    "matrixOrder",
    "kind",
    "checkLimits",
    "warningDistance",
    "tie",
    "axes",
    "unshared",
    "home",
)
"""The instance variables of the base block."""


@dataclass(frozen=True)
class Method:
    """A method as text: its declaration with parameters, and its local variables with the statements."""

    head: str
    text: str


def inherited_texts(contract: Contract, templates: Environment) -> frozenset[str]:
    """The statements of the methods that a geometry need not override, if those of the base block are right for it."""
    plain = (
        _method(contract.overridable[name], name, contract, templates)
        for name in ("FindImage", "FindMargins", "FindBias")
    )
    signature = contract.overridable["FindProjection"]
    projections = (
        templates.get_template("methods/FindProjection.st.j2").render(contract.spelling, program=program)
        for program in (followed(signature, contract), about_z(signature, contract))
    )
    written = (*plain, *(Method(signature.head(), with_gathered(tidy(text))) for text in projections))
    return frozenset(map(statements_of, written))


def statements_of(method: Method) -> str:
    """The method without the lines that are comments alone."""
    return _COMMENTS.sub("", f"{method.head}\n{method.text}")


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
    yield from contract.private.values()
    yield from contract.offered.values()
    yield from contract.overridable.values()
    yield from contract.supplied.values()


def _template(signature: Signature, contract: Contract) -> str:
    if signature.name in contract.supplied:
        return "Supplied"
    return {**_OF_AXES, **_FROM}.get(signature.name, signature.name)


def _method(signature: Signature, template: str, contract: Contract, templates: Environment) -> Method:
    text = templates.get_template(f"base/{template}.st.j2").render(
        contract.spelling,
        method=signature.name,
        parameters=[p.name for p in signature.parameters],
        returns=signature.returns,
        projection=about_z(signature, contract) if signature.name == "FindProjection" else None,
    )
    return Method(signature.head(), with_gathered(tidy(text)))
