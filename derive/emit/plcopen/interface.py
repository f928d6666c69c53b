"""The elements of PLCopenXML that hold the declaration of an object: sections, variables, types, pragmas."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

from derive.emit.plcopen.declaration import Attributes, Declaration, Variable

_EXTENSION = "http://www.3s-software.com/plcopenxml/"
_XHTML = "http://www.w3.org/1999/xhtml"
_SECTIONS = {"VAR": "localVars", "VAR_INPUT": "inputVars", "VAR_OUTPUT": "outputVars", "VAR_IN_OUT": "inOutVars"}
_ELEMENTARY = re.compile(r"BOOL|BYTE|D?WORD|U?[SDL]?INT|L?REAL|TIME")
_ARRAY = re.compile(r"ARRAY\[(.+?)\] OF (.+)")
_STRING = re.compile(r"STRING\((\d+)\)")


def add_data(parent: ET.Element, name: str, unknown: str = "implementation") -> ET.Element:
    """Add an entry to the `addData` of an element, which is created if it is missing.

    Returns the element for the content of the entry.
    """
    extensions = parent.find("addData")
    if extensions is None:
        extensions = ET.SubElement(parent, "addData")
    return ET.SubElement(extensions, "data", name=_EXTENSION + name, handleUnknown=unknown)


def add_text(parent: ET.Element, text: str) -> None:
    """Add plain text as it is."""
    ET.SubElement(parent, "xhtml", xmlns=_XHTML).text = text


def add_attributes(parent: ET.Element, attributes: Attributes) -> None:
    """Add the pragmas of a declaration, if it has any."""
    if attributes:
        holder = ET.SubElement(add_data(parent, "attributes"), "Attributes")
        for name, value in attributes:
            ET.SubElement(holder, "Attribute", Name=name, Value=value)


def add_base_type(parent: ET.Element, declared: Declaration) -> None:
    """Add the structure or the enumeration that a data type is."""
    if declared.sections:
        add_variables(ET.SubElement(parent, "struct"), declared)
        return
    values = ET.SubElement(ET.SubElement(parent, "enum"), "values")
    for name, number in declared.enumerators:
        ET.SubElement(values, "value", name=name, value=str(number))


def add_variables(parent: ET.Element, declared: Declaration) -> None:
    """Add the variables of a declaration that has one section."""
    for variable in declared.sections[0].variables:
        _add_variable(parent, variable)


def add_interface(parent: ET.Element, declared: Declaration) -> ET.Element:
    """Add the typed copy of a declaration."""
    interface = ET.SubElement(parent, "interface")
    if declared.returns:
        _add_type(ET.SubElement(interface, "returnType"), declared.returns)
    for section in declared.sections:
        element = ET.SubElement(interface, _SECTIONS[section.scope])
        if section.is_constant:
            element.set("constant", "true")
        for variable in section.variables:
            _add_variable(element, variable)
    if declared.extends or declared.interfaces:
        inheritance = ET.SubElement(add_data(interface, "pouinheritance"), "Inheritance")
        if declared.extends:
            ET.SubElement(inheritance, "Extends").text = declared.extends
        for name in declared.interfaces:
            ET.SubElement(inheritance, "Implements").text = name
    add_attributes(interface, declared.attributes)
    return interface


def _add_variable(parent: ET.Element, variable: Variable) -> None:
    element = ET.SubElement(parent, "variable", name=variable.name)
    _add_type(ET.SubElement(element, "type"), variable.type)
    if variable.initial:
        _add_value(ET.SubElement(element, "initialValue"), variable.initial)
    add_attributes(element, variable.attributes)
    if variable.comment:
        add_text(ET.SubElement(element, "documentation"), variable.comment)


def _add_value(parent: ET.Element, value: str) -> None:
    """Add an initial value. The value of an array is a list in square brackets, which holds no further list."""
    if not value.startswith("["):
        ET.SubElement(parent, "simpleValue", value=value)
        return
    values = ET.SubElement(parent, "arrayValue")
    for one in value.strip("[] ").split(","):
        ET.SubElement(ET.SubElement(values, "value"), "simpleValue", value=one.strip())


def _add_type(parent: ET.Element, type_text: str) -> None:
    if _ELEMENTARY.fullmatch(type_text):
        ET.SubElement(parent, type_text)
    elif sizes := _STRING.fullmatch(type_text):
        ET.SubElement(parent, "string", length=sizes.group(1))
    elif array := _ARRAY.fullmatch(type_text):
        element = ET.SubElement(parent, "array")
        for bounds in array.group(1).split(", "):
            lower, upper = bounds.split("..")
            ET.SubElement(element, "dimension", lower=lower, upper=upper)
        _add_type(ET.SubElement(element, "baseType"), array.group(2))
    elif type_text.startswith("POINTER TO "):
        element = ET.SubElement(parent, "pointer")
        _add_type(ET.SubElement(element, "baseType"), type_text.removeprefix("POINTER TO "))
    else:
        ET.SubElement(parent, "derived", name=type_text)
