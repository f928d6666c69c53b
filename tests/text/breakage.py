"""Ways to break a unit: a text in a method, and the wrong text that replaces it."""

from collections.abc import Mapping
from dataclasses import dataclass

from derive.description.mechanism import Mechanism
from tests.text.pairs import MECHANISMS
from tests.text.units import file_of, shared_texts, text_of

(MECHANISM,) = (m for m in MECHANISMS if m.name == "Kin_Scara4_ZCcoupled_Type1")


@dataclass(frozen=True)
class Break:
    """A change to the first place behind the declaration of a method, a block or a shared function."""

    where: str
    right: str
    wrong: str
    said: str = ""
    """The message of the harness; empty where a comparison must fail."""


def texts(change: Break | None = None, mechanism: Mechanism = MECHANISM) -> Mapping[str, str]:
    """The unit of a mechanism and the shared objects, with a change to one of them."""
    found = {**shared_texts(), file_of(mechanism): text_of(mechanism)}
    if change is not None:
        *_, file = [
            file for file, text in found.items() if change.where in text and f"{change.where}\n" in declared(text)
        ]
        start = found[file].index(change.where)
        end = found[file].index(f"END_{change.where.split()[0]}", start)
        head, own, rest = found[file][:start], found[file][start:end], found[file][end:]
        assert change.right in own, change
        found[file] = head + own.replace(change.right, change.wrong, 1) + rest
    return found


def declared(text: str) -> str:
    words = ("METHOD ", "FUNCTION", "PROPERTY ")
    lines = [line for line in text.split("\n") if line.startswith(words)]
    return "\n".join(line.split(" :")[0].split(" EXTENDS ")[0].removesuffix(" IMPLEMENTS") for line in lines) + "\n"


_BLOCK = f"FUNCTION_BLOCK {MECHANISM.block_name}"
_INITIALIZE, _FORWARD = "METHOD PROTECTED ReadInputs", "METHOD PROTECTED FindPose"
_INVERSE, _BRANCH = "METHOD PROTECTED FindAxes", "METHOD PROTECTED SolveBranch"
_NEAREST = "METHOD PROTECTED FindNearest"
_WRITTEN, _BYTES = "METHOD PUBLIC AxesToCartesian", "METHOD PRIVATE Configure"
_SINGULAR, _JACOBIAN = "METHOD PUBLIC IsSingularity", "METHOD PROTECTED FindJacobian"
_DESCRIBE, _MARGINS = "METHOD PROTECTED Describe", "METHOD PROTECTED FindMargins"

REFUSED = {
    "a missing semicolon": Break("METHOD PUBLIC IsInitialized", ":= initialized;", ":= initialized", "missing ';'"),
    "a missing END_IF": Break(_SINGULAR, "  RETURN;\nEND_IF", "  RETURN;", "END_IF"),
    "an undeclared name": Break(_BRANCH, "reach := ", "reached := ", "undeclared name reached"),
    "an undeclared function": Break(_BRANCH, "Softkin_Root", "Softkin_Sqrt", "undeclared function Softkin_Sqrt"),
    "a wrong type": Break(_INITIALIZE, ":= xCheckLimits;", ":= dLinkLength1;", "LREAL does not fit BOOL"),
    "a wrong type of a number": Break(_NEAREST, "1 - 2*(rest MOD 2)", "1.0", "LREAL does not fit INT"),
    "a wrong argument": Break(_WRITTEN, "aElements := rot", "aElements := f", "not a SMC_Frame"),
    "a write to a constant input": Break(_FORWARD, "v.dX := ", "a.a0 := ", "VAR_IN_OUT CONSTANT a"),
    "a constant input that is handed on": Break(
        _BRANCH, "a.a0 := axisA1;", "Softkin_MakeRotation(aElements := rot);", "VAR_IN_OUT CONSTANT rot"
    ),
    "a write outside Initialize": Break(_MARGINS, "sinA2 := ", "linkLength2 := ", "Initialize"),
    "a write to an input of the block": Break(
        _FORWARD, "v.dX := ", "dLinkLength1 := ", "writes the input dLinkLength1"
    ),
    "a missing method": Break(
        "FUNCTION_BLOCK Softkin_Kinematics", "PUBLIC AxesToOrientation", "PUBLIC Other", "AxesToOrientation"
    ),
    "a missing property": Break("PROPERTY PUBLIC NumAxes", "NumAxes", "Count", "NumAxes"),
    "a property of another type": Break("PROPERTY PUBLIC NumAxes", "NumAxes : UDINT", "NumAxes : UINT", "is a UDINT"),
    "another result": Break("METHOD PUBLIC GetConfigurationDataSize", " : INT", " : DINT", "returns INT, not DINT"),
    "another length of a string": Break(
        "METHOD PUBLIC GetKinematicsName", "STRING(255)", "STRING(300)", "returns STRING"
    ),
    "a method of an interface that is private": Break(
        "METHOD PUBLIC IsInitialized", "PUBLIC IsInitialized", "PRIVATE IsInitialized", "must be public"
    ),
    "a parameter of another name": Break(
        "METHOD PUBLIC ActivateAutomaticRotaryPeriods",
        "  cdSrc : TRAFO.CONFIGDATA;\nEND_VAR\nVAR\n",
        "  cdSource : TRAFO.CONFIGDATA;\nEND_VAR\nVAR\n  cdSrc : TRAFO.CONFIGDATA;\n",
        "cdsrc",
    ),
    "one parameter more": Break(
        "METHOD PUBLIC GetAxisProperties",
        "  udiAxis : UDINT;",
        "  udiAxis : UDINT;\n  udiMore : UDINT;",
        "has 2 parameters, not 3",
    ),
    "parameters in another order": Break(
        "METHOD PUBLIC CPConnectible", "  cd1 : TRAFO.CONFIGDATA;\n  cd2", "  cd2 : TRAFO.CONFIGDATA;\n  cd1", "cd1"
    ),
    "a parameter of another scope": Break(_SINGULAR, "VAR_IN_OUT CONSTANT", "VAR_IN_OUT", "VAR_IN_OUT CONSTANT"),
    "a parameter of another type": Break(
        "METHOD PUBLIC GetAxisProperties", "udiAxis : UDINT", "udiAxis : UINT", "UDINT"
    ),
    "a result that is never given": Break(
        "METHOD PUBLIC GetKinematicsName", "GetKinematicsName := ", "// ", "never assigns"
    ),
    "the same name twice": Break(_FORWARD, "sinA12, a3,", "sinA12, a3, A3,", "duplicate name"),
    "a name of a method": Break(_BRANCH, "headingAcross, reach,", "headingAcross, jacobian,", "hides a member"),
    "an error that does not exist": Break(_FORWARD, "Softkin_Names.NoError", "Softkin_Names.Fine", "no member"),
    "an axis that does not exist": Break(_BRANCH, "a.a3 := axisA4;", "a.a6 := axisA4;", "no field a6"),
    "a byte that does not exist": Break(f"{_BLOCK}_Config", "abyData[3]", "abyData[32]", "outside"),
    "a division of integers": Break(_BRANCH, "headingAlong := ", "headingAlong := 1/2 + ", "not allowed"),
}

FAULTS = {
    "a division by zero": Break(_BRANCH, "angleA1*RADIAN", "angleA1/0.0", "division by zero"),
    "a root of a negative": Break(_BRANCH, "reach := SQRT(", "reach := SQRT(-1.0E12 + ", "SQRT of a negative"),
    "a product that overflows": Break(_FORWARD, "cosA1 := COS(a1)", "cosA1 := 1.0E200*COS(a1)*1.0E200", "not finite"),
    "an unused axis that is read": Break(_FORWARD, "a.a2 - axes[2].offset", "a.a2 - a.a4", "not finite"),
    "an integer that overflows": Break(_NEAREST, ":= 1 - 2*(rest MOD 2)", ":= rest + 32767 + slots", "overflow"),
    "numbers that are not checked": Break(
        "FUNCTION Softkin_AreNumbers", "IF index < udiAxes THEN", "IF index < 0 THEN", "not finite"
    ),
}

WRONG = {
    "CartesianToAxes: a sign": Break(_BRANCH, "v.dY - armAcrossA1*v.dX", "v.dY + armAcrossA1*v.dX"),
    "AxesToCartesian: a sign": Break(_FORWARD, "v.dZ := a3 - ", "v.dZ := a3 + "),
    "CartesianToAxes: an offset": Break(_BRANCH, "axisA3 := a3 + axes[2].offset;", "axisA3 := a3;"),
    "CartesianToAxes: two axes exchanged": Break(
        _BRANCH, "a.a0 := axisA1;\na.a1 := axisA2;", "a.a0 := axisA2;\na.a1 := axisA1;"
    ),
    "CartesianToAxes: an unused axis": Break(_BRANCH, "a.a3 := axisA4;", "a.a3 := axisA4;\na.a5 := 1.0;"),
    "AxesToCartesian: two bytes exchanged": Break(
        _BYTES, "Softkin_PeriodNumber(values[index])", "Softkin_PeriodNumber(values[0])"
    ),
    "AxesToCartesian: a byte without a meaning": Break(_BYTES, "cd := ", "bytes.abyData[30] := 7;\ncd := "),
    "CartesianToAxes: a tie": Break(_NEAREST, "least - tie", "least + 1.0E6"),
    "CartesianToAxes: a tolerance": Break(_BRANCH, "ABS(cosA2) <= boundOfCosA2", "ABS(cosA2) <= 0.9"),
    "CartesianToAxes: an error": Break(
        _BRANCH,
        "iReason := 2;\n    SolveBranch := Softkin_Names.Unreachable",
        "iReason := 2;\n    SolveBranch := Softkin_Names.InvalidCoupling",
    ),
    "CartesianToAxes: a limit": Break(_INVERSE, "IF NOT areInside THEN", "IF areInside THEN"),
    "CartesianToAxes: an output before a refusal": Break(
        _INVERSE,
        "IF status = Softkin_Names.NoError THEN\n  a := solution;",
        "IF status <> Softkin_Names.NotInitialized THEN\n  a := solution;",
    ),
    "CartesianToAxes: a turn": Break("FUNCTION Softkin_NearOf", "number, number - 1)", "number, number)"),
    "CartesianToAxes: byte 3": Break(_INVERSE, "ABS(choice.aSigns[0]) > 1", "choice.aSigns[0] > 1"),
    "Jacobian: a column": Break(_JACOBIAN, "J[3, 3] := 1.0;", "J[3, 3] := 0.0;"),
    "Jacobian: an element outside": Break("METHOD PUBLIC Jacobian", "J := found;", "J := found;\n  J[5, 5] := 1.0;"),
    "AxesToOrientation: an element": Break(
        "METHOD PROTECTED FindOrientation", "rot[2, 1] := sinA124", "rot[2, 1] := cosA124"
    ),
    "IsSingularity: a threshold": Break(_SINGULAR, "< warningDistance", "< 900.0*warningDistance"),
    "GetAxisProperties: a type": Break(_DESCRIBE, "xRotary := FALSE", "xRotary := TRUE"),
    "GetOrientationImage: a freedom": Break(
        _DESCRIBE, "Softkin_Names.TurningOrientation", "Softkin_Names.FixedOrientation"
    ),
    "GetFlangeOrientationImageWithOri: an axis": Break(
        "METHOD PUBLIC GetFlangeOrientationImageWithOri", "vRot.dZ := projected[3, 3]", "vRot.dZ := projected[1, 1]"
    ),
    "AxesToConfiguration_Offset: a sign": Break("METHOD PROTECTED FindOffsetBranches", "toolX*sinA2", "toolY*sinA2"),
    "CartesianToAxes_Offset: a sign": Break("METHOD PROTECTED SolveOffsetBranch", "v.dZ - toolZ", "v.dZ + toolZ"),
    "GetKinematicsName: a name": Break(_DESCRIBE, "'Kin_Scara4_ZCcoupled'", "'Kin_Scara4'"),
    "GetPeriods: an axis": Break(_DESCRIBE, "aAxisOfTurn[0] := 3", "aAxisOfTurn[0] := 2"),
    "CPConnectible: anything": Break("METHOD PUBLIC CPConnectible", "CPConnectible := FALSE", "CPConnectible := TRUE"),
    "CartesianToAxes: a constant of the machine": Break(
        _INITIALIZE, "linkLength2 := dLinkLength2;", "linkLength2 := 1.01*dLinkLength2;"
    ),
}
"""The method that then answers otherwise, and what is wrong."""
