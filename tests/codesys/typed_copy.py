"""The variables of an object, from the typed elements of PLCopenXML and from the parsed text, in one form."""

import re
from collections.abc import Iterator, Sequence

from tests.codesys.plcopen_reader import NAMESPACE, Element
from tests.harness import ast

Variables = list[tuple[str, bool, str, str, str]]
"""Section, whether it is constant, name, type, and the initial value where it is a plain one."""

_SECTIONS = {"localVars": "VAR", "inputVars": "VAR_INPUT", "outputVars": "VAR_OUTPUT", "inOutVars": "VAR_IN_OUT"}
_P = f"{{{NAMESPACE}}}"


def typed_variables(root: Element) -> dict[str, Variables]:
    """The variables of every block, function and method, by its path; the type it returns is the first entry."""
    found = {}
    for pou in root.iter(f"{_P}pou"):
        name = str(pou.attrib["name"])
        found[name] = list(_interface(pou))
        for member in (*pou.iter(f"{_P}Method"), *pou.iter(f"{_P}Property")):
            found[f"{name}.{member.attrib['name']}"] = list(_interface(member))
    for interface in root.iter(f"{_P}Interface"):
        for method in interface.iter(f"{_P}Method"):
            found[f"{interface.attrib['name']}.{method.attrib['name']}"] = list(_interface(method))
    for constants in root.iter(f"{_P}globalVars"):
        found[str(constants.attrib["name"])] = list(_variables(constants, "VAR_GLOBAL"))
    return found


def declared_variables(declared: ast.Declaration) -> Iterator[tuple[str, Variables]]:
    """The variables of every block, function and method from the syntax tree, in the same form."""
    if isinstance(declared, ast.Block):
        yield declared.name, list(_sections(declared.sections))
        for method in declared.methods:
            yield f"{declared.name}.{method.name}", [*_returned(method.returns), *_sections(method.sections)]
        for prop in declared.properties:
            yield f"{declared.name}.{prop.name}", list(_returned(prop.type))
    elif isinstance(declared, ast.Interface):
        for method in declared.methods:
            yield f"{declared.name}.{method.name}", [*_returned(method.returns), *_sections(method.sections)]
    elif isinstance(declared, ast.Routine):
        yield declared.name, [*_returned(declared.returns), *_sections(declared.sections)]
    elif isinstance(declared, ast.Globals):
        yield declared.name, list(_sections((ast.Section("VAR_GLOBAL", declared.constant, declared.variables),)))


def _interface(element: Element) -> Iterator[tuple[str, bool, str, str, str]]:
    interface = element.find(f"{_P}interface")
    assert interface is not None
    for section in interface:
        kind = section.tag.removeprefix(_P)
        if kind == "returnType":
            yield "", False, "", _type(section), ""
        else:
            yield from _variables(section, _SECTIONS.get(kind, ""))


def _variables(section: Element, scope: str) -> Iterator[tuple[str, bool, str, str, str]]:
    for variable in section.iterfind(f"{_P}variable"):
        written = variable.find(f"{_P}type")
        assert written is not None and scope
        value = variable.find(f"{_P}initialValue/{_P}simpleValue")
        initial = "" if value is None else str(value.attrib["value"])
        is_constant = section.get("constant") == "true"
        yield scope, is_constant, str(variable.attrib["name"]), _type(written), _number(initial)


def _type(holder: Element) -> str:
    (written,) = holder
    kind = written.tag.removeprefix(_P)
    base = written.find(f"{_P}baseType")
    if kind == "array":
        assert base is not None
        bounds = ", ".join(f"{d.attrib['lower']}..{d.attrib['upper']}" for d in written.iterfind(f"{_P}dimension"))
        return f"ARRAY[{bounds}] OF {_type(base)}"
    if kind == "pointer":
        assert base is not None
        return f"POINTER TO {_type(base)}"
    if kind == "string":
        return f"STRING({written.attrib['length']})"
    return str(written.attrib["name"]) if kind == "derived" else kind


def _returned(returns: ast.TypeText | None) -> Iterator[tuple[str, bool, str, str, str]]:
    if returns is not None:
        yield "", False, "", re.sub(r"^STRING_(\d+)_$", r"STRING(\1)", returns.text), ""


def _sections(sections: Sequence[ast.Section]) -> Iterator[tuple[str, bool, str, str, str]]:
    for section in sections:
        for v in section.variables:
            yield section.scope, section.constant, v.name, v.type.text, _number(_written(v.initial))


def _written(initial: ast.Expression | None) -> str:
    """A literal or a dotted path of names as text; an empty text for any other value."""
    if isinstance(initial, ast.Member):
        return f"{_written(initial.object)}.{initial.name}"
    if isinstance(initial, ast.Name):
        return initial.text
    if isinstance(initial, ast.Unary) and initial.operator == "-":
        return f"-{_written(initial.operand)}"
    return str(initial.value) if isinstance(initial, ast.Literal) else ""


def _number(text: str) -> str:
    """A literal in one form: 1.0E9 and 1000000000.0 are the same, TRUE and True too."""
    try:
        return repr(float(text))
    except ValueError:
        return text.upper()
