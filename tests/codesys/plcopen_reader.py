"""A reader of PLCopenXML that takes from a file what CODESYS takes, at the same places."""

from pathlib import Path

from lxml import etree

from tests.codesys.parts import Part, Whole

NAMESPACE = "http://www.plcopen.org/xml/tc6_0200"
_XHTML = "{http://www.w3.org/1999/xhtml}xhtml"
_KINDS = {"function": "FUNCTION", "functionBlock": "FUNCTION_BLOCK", "program": "PROGRAM"}
_IN = {"p": NAMESPACE}
_OBJECT_TEXT = "p:addData/p:data[@name='http://www.3s-software.com/plcopenxml/interfaceasplaintext']"
Element = etree._Element


def parse(path: Path) -> Element:
    return etree.fromstring(path.read_bytes())


def wholes(root: Element) -> dict[str, Whole]:
    """Every object by its name, with its text and that of its members."""
    found = {}
    for data_type in root.iterfind("p:types/p:dataTypes/p:dataType", _IN):
        name = data_type.attrib["name"]
        found[name] = Whole(Part("TYPE", name, declaration=_plain(data_type, _OBJECT_TEXT)))
    for constants in _lists(root):
        name = str(constants.attrib["name"])
        found[name] = Whole(Part("VAR_GLOBAL", name, declaration=_plain(constants, _OBJECT_TEXT)))
    for interface in _interfaces(root):
        name = str(interface.attrib["name"])
        methods = interface.iterfind("p:Methods/p:Method", _IN)
        members = [Part("METHOD", f"{name}.{one.attrib['name']}", _plain(one)) for one in methods]
        found[name] = Whole(Part("INTERFACE", name, _plain(interface)), members)
    for pou in root.iterfind("p:types/p:pous/p:pou", _IN):
        name = pou.attrib["name"]
        own = _part(pou, _KINDS[pou.attrib["pouType"]], name, _OBJECT_TEXT)
        found[name] = Whole(own, [*_methods(pou, name), *_properties(pou, name)])
    return found


def _lists(root: Element) -> list[Element]:
    """The lists of global variables, which are entries of the project."""
    return list(root.iterfind(f"p:addData/{_extension('globalvars')}/p:globalVars", _IN))


def _interfaces(root: Element) -> list[Element]:
    """The interfaces, which are entries of the project, too."""
    return list(root.iterfind(f"p:addData/{_extension('interface')}/p:Interface", _IN))


def folders(root: Element) -> dict[str, list[str]]:
    """The names of the objects in every folder below the one at the top."""
    (structure,) = root.iterfind(f"p:addData/{_extension('projectstructure')}/p:ProjectStructure", _IN)
    (top,) = structure
    return {f.attrib["Name"]: [one.attrib["Name"] for one in f] for f in top}


def identifiers(root: Element) -> dict[str, str]:
    """The identifier of every object and member where it is declared, by its path."""
    found = {}
    holders = (*root.iterfind("p:types", _IN), *_lists(root))
    for one in (inner for holder in holders for inner in holder.iterfind(".//p:ObjectId", _IN)):
        owner = one.getparent().getparent().getparent()  # type: ignore[union-attr]
        found[owner.attrib["name"]] = one.text or ""  # type: ignore[union-attr]
    for interface in _interfaces(root):
        own = str(interface.attrib["name"])
        found[own] = str(interface.attrib["ObjectId"])
        for one in interface.iterfind("p:Methods/p:Method", _IN):
            found[f"{own}.{one.attrib['name']}"] = str(one.attrib["ObjectId"])
    for member in root.iterfind("p:types//*[@ObjectId]", _IN):
        owner = next(a for a in member.iterancestors(f"{{{NAMESPACE}}}pou"))
        found[f"{owner.attrib['name']}.{member.attrib['name']}"] = str(member.attrib["ObjectId"])
    return found


def listed(root: Element) -> dict[str, str]:
    """The identifiers in the project structure, by path."""
    found = {}
    for one in root.iterfind("p:addData//p:Folder/p:Object", _IN):
        found[one.attrib["Name"]] = one.attrib["ObjectId"]
        found |= {f"{one.attrib['Name']}.{m.attrib['Name']}": m.attrib["ObjectId"] for m in one}
    return {str(k): str(v) for k, v in found.items()}


def _extension(name: str) -> str:
    """The path below an element's `addData` to an entry of the vendor."""
    return f"p:data[@name='http://www.3s-software.com/plcopenxml/{name}']"


def _plain(element: Element, where: str = ".") -> str:
    """The plain text of a declaration: of methods and accessors a child, of objects in `addData`."""
    (text,) = element.iterfind(f"{where}/p:InterfaceAsPlainText/{_XHTML}", _IN)
    return text.text or ""


def _part(element: Element, kind: str, path: str, where: str = ".") -> Part:
    (body,) = element.iterfind(f"p:body/p:ST/{_XHTML}", _IN)
    return Part(kind, path, _plain(element, where), body.text or "")


def _methods(pou: Element, owner: str) -> list[Part]:
    where = f"p:addData/{_extension('method')}/p:Method"
    return [_part(one, "METHOD", f"{owner}.{one.attrib['name']}") for one in pou.iterfind(where, _IN)]


def _properties(pou: Element, owner: str) -> list[Part]:
    found = []
    for one in pou.iterfind(f"p:addData/{_extension('property')}/p:Property", _IN):
        path = f"{owner}.{one.attrib['name']}"
        (getter,) = one.iterfind("p:GetAccessor", _IN)
        found += [Part("PROPERTY", path, _plain(one)), _part(getter, "GET", path)]
    return found
