"""PLCopenXML as CODESYS V3.5 reads it: objects with their text, a typed copy of their declarations, and folders.

CODESYS takes the plain text of a declaration, which keeps comments and pragmas; other tools read the typed copy. Data
for which the standard has no element stands in `addData`, in the elements that CODESYS itself writes.
"""

from __future__ import annotations

import re
import uuid
import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence

from derive.emit.plcopen.declaration import declaration_of
from derive.emit.plcopen.interface import (
    add_attributes,
    add_base_type,
    add_data,
    add_interface,
    add_text,
    add_variables,
)
from derive.emit.plcopen.objects import Object
from derive.kept import kept_by_identity

Folders = Mapping[str, Sequence[Object]]
"""The objects by the folder that holds them."""

_NAMESPACE = "http://www.plcopen.org/xml/tc6_0200"
_IDENTIFIERS = uuid.uuid5(uuid.NAMESPACE_DNS, "softkin")
_DATE = "2000-01-01T00:00:00"
"""The schema requires a date. It is constant, so that the same objects give the same file."""
_GETTER = "VAR\nEND_VAR"
"""The declaration of a getter, as CODESYS itself writes it."""
_IN_DATA = {"VAR_GLOBAL": "globalvars", "INTERFACE": "interface"}
"""The objects for which the standard has no element, by the data that holds them."""
_LEVEL = 3
"""How deep an object is in a file, whatever its kind."""
_PLACE = re.compile(r'<place number="(\d+)" />')
_POU_TYPES = {"FUNCTION": "function", "FUNCTION_BLOCK": "functionBlock", "PROGRAM": "program"}


def document(title: str, remark: str, folders: Folders) -> str:
    """A file with these objects, in folders below a folder with the title."""
    root = ET.Element("project", xmlns=_NAMESPACE)
    _headers(root, title, remark)
    objects = [one for inside in folders.values() for one in inside]
    types = ET.SubElement(root, "types")
    data_types, pous = ET.SubElement(types, "dataTypes"), ET.SubElement(types, "pous")
    for number, one in enumerate(objects):
        if one.kind == "TYPE":
            _placed(data_types, number)
        elif one.kind in _POU_TYPES:
            _placed(pous, number)
    ET.SubElement(ET.SubElement(root, "instances"), "configurations")
    for number, one in enumerate(objects):
        if one.kind in _IN_DATA:
            _placed(add_data(root, _IN_DATA[one.kind]), number)
    structure = ET.SubElement(add_data(root, "projectstructure", "discard"), "ProjectStructure")
    _structure(ET.SubElement(structure, "Folder", Name=title), folders)
    ET.indent(root)
    text = _PLACE.sub(lambda place: _written(objects[int(place[1])]), ET.tostring(root, encoding="unicode"))
    return f'<?xml version="1.0" encoding="utf-8"?>\n{text}\n'


def _placed(parent: ET.Element, number: int) -> None:
    """Leave a place for an object: many files hold the same object, whose text is written once."""
    ET.SubElement(parent, "place", number=str(number))


@kept_by_identity(2000)
def _written(one: Object) -> str:
    """The element of an object as text."""
    holder = ET.Element("holder")
    {"TYPE": _data_type, "VAR_GLOBAL": _global_constants, "INTERFACE": _interface}.get(one.kind, _pou)(holder, one)
    (element,) = holder
    _indent(element)
    return ET.tostring(element, encoding="unicode")


def _indent(root: ET.Element) -> None:
    """Indent an object: one element on each line, but a variable with all its elements on one line."""
    ET.indent(root, level=_LEVEL)
    for variable in root.iter("variable"):
        for element in variable.iter():
            if len(element):
                element.text = None
            for inner in element:
                inner.tail = None


def _headers(root: ET.Element, title: str, remark: str) -> None:
    ET.SubElement(root, "fileHeader", companyName="", productName="Softkin", productVersion="", creationDateTime=_DATE)
    content = ET.SubElement(root, "contentHeader", name=title, modificationDateTime=_DATE)
    ET.SubElement(content, "Comment").text = remark
    coordinates = ET.SubElement(content, "coordinateInfo")
    for language in ("fbd", "ld", "sfc"):
        ET.SubElement(ET.SubElement(coordinates, language), "scaling", x="1", y="1")
    ET.SubElement(add_data(content, "projectinformation"), "ProjectInformation")


def _data_type(parent: ET.Element, one: Object) -> None:
    element = ET.SubElement(parent, "dataType", name=one.name)
    declared = declaration_of(one.declaration)
    add_base_type(ET.SubElement(element, "baseType"), declared)
    add_attributes(element, declared.attributes)
    _text_and_identifier(element, one)


def _global_constants(parent: ET.Element, one: Object) -> None:
    """A list of global constants. The standard has them in a resource alone; CODESYS writes them into the project."""
    declared = declaration_of(one.declaration)
    element = ET.SubElement(parent, "globalVars", name=one.name, constant="true")
    add_variables(element, declared)
    add_attributes(element, declared.attributes)
    _text_and_identifier(element, one)


def _interface(parent: ET.Element, one: Object) -> None:
    """An interface, which the standard does not have: what it extends stands in its text alone."""
    element = ET.SubElement(parent, "Interface", name=one.name, ObjectId=_identifier(one.name))
    methods = ET.SubElement(element, "Methods")
    for member in one.members:
        method = ET.SubElement(methods, "Method", name=member.name, ObjectId=_identifier(one.name, member.name))
        add_interface(method, declaration_of(member.declaration))
        _own_text(method, member)
    _own_text(element, one)


def _own_text(element: ET.Element, one: Object) -> None:
    """The text of a declaration that CODESYS reads in the object itself."""
    add_text(ET.SubElement(element, "InterfaceAsPlainText"), one.declaration)
    ET.SubElement(element, "addData")


def _pou(parent: ET.Element, one: Object) -> None:
    element = ET.SubElement(parent, "pou", name=one.name, pouType=_POU_TYPES[one.kind])
    add_interface(element, declaration_of(one.declaration))
    _body(element, one)
    for member in one.members:
        if member.kind == "METHOD":
            _method(add_data(element, "method"), member, one)
    for member in one.members:
        if member.kind == "PROPERTY":
            _property(add_data(element, "property"), member, one)
    _text_and_identifier(element, one)


def _method(parent: ET.Element, one: Object, owner: Object) -> None:
    element = ET.SubElement(parent, "Method", name=one.name, ObjectId=_identifier(owner.name, one.name))
    interface = add_interface(element, declaration_of(one.declaration))
    for access in ("Private", "Protected"):
        if f"METHOD {access.upper()} {one.name}" in one.declaration:
            ET.SubElement(add_data(interface, "accessmodifiers"), "AccessModifiers", {access: "true"})
    _body(element, one)
    _own_text(element, one)


def _property(parent: ET.Element, one: Object, owner: Object) -> None:
    element = ET.SubElement(parent, "Property", name=one.name, ObjectId=_identifier(owner.name, one.name))
    add_interface(element, declaration_of(one.declaration))
    (getter,) = one.members
    accessor = ET.SubElement(element, "GetAccessor")
    ET.SubElement(accessor, "interface")
    _body(accessor, getter)
    for inside, text in ((accessor, getter.declaration or _GETTER), (element, one.declaration)):
        add_text(ET.SubElement(inside, "InterfaceAsPlainText"), text)
        ET.SubElement(inside, "addData")


def _body(parent: ET.Element, one: Object) -> None:
    add_text(ET.SubElement(ET.SubElement(parent, "body"), "ST"), one.implementation)


def _text_and_identifier(element: ET.Element, one: Object) -> None:
    add_text(ET.SubElement(add_data(element, "interfaceasplaintext"), "InterfaceAsPlainText"), one.declaration)
    ET.SubElement(add_data(element, "objectid", "discard"), "ObjectId").text = _identifier(one.name)


def _structure(root: ET.Element, folders: Folders) -> None:
    for name, objects in folders.items():
        folder = ET.SubElement(root, "Folder", Name=name)
        for one in objects:
            entry = ET.SubElement(folder, "Object", Name=one.name, ObjectId=_identifier(one.name))
            for member in one.members:  # other tools import the members that are listed here, and no others
                ET.SubElement(entry, "Object", Name=member.name, ObjectId=_identifier(one.name, member.name))


def _identifier(*path: str) -> str:
    """The identifier of an object: made from its name, so that it is the same in every file."""
    return str(uuid.uuid5(_IDENTIFIERS, ".".join(path)))
