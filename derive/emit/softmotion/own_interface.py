"""The interface of our own, by which a program calls the kinematics that is active in an axis group."""

from __future__ import annotations

from dataclasses import replace

from jinja2 import Environment

from derive.emit.st.contract import Contract


def interface_text(contract: Contract, templates: Environment) -> str:
    """The text of the interface: the methods of the contract that are our own, with the headers that blocks have."""
    heads = [replace(signature, access="").head() for signature in contract.own.values()]
    return templates.get_template("interface.st.j2").render(contract.spelling, heads=heads)
