"""`python -m bench.compiled STRUCPP`: instructions of a whole CartesianToAxes, generated and by hand, by one compiler.

STRUCPP is a built copy of github.com/Autonomy-Logic/STruCpp, which makes C++ of Structured Text; g++ compiles it, and
Callgrind counts. By hand is the text of `bench/hand` with the checks that a generated block does: initialised, bytes,
numbers, rotation, turns, limits, written where they are needed. Both read the opaque matrix by the same function,
`Softkin_ReadMatrix`.
"""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from bench.blocks import FOLDER, KINDS, Kind, _poses
from bench.counting import counting_library
from derive.description.mechanism import Mechanism
from derive.emit.softmotion.inputs import wanted_name
from derive.kinematics.parameters import machine_parameters
from tests.harness import stubs
from tests.mechanisms import catalogue
from tests.text.controller import OK, Controller
from tests.text.units import file_of, shared_texts, text_of

GOALS = {"SCARA": 1.3, "rotary delta": 1.15, "six-axis": 1.15}
"""The most instructions of the generated block, in those of the block by hand."""
_LARGE = "1.0E9"
_REPEATS = 10
_UNNEEDED = ("ISoftkin", "Softkin_Names", "Softkin_SelfTest", "Softkin_CheckLine", "Softkin_Teach", "Softkin_SolveMany")
_NO_ERROR, _CLOSED = "SMCE.SMC_NO_ERROR", "SMCE.SMC_TRAFO_NOT_INITIALIZED"
_BAD = "SMCE.SMC_CP_ERROR_CREATING_PARAM_TRANSFORM"
_BEYOND = "SMCE.SMC_AXIS_INVERSE_TRAFO_EXCEEDING_POSLIMITS"


def main() -> int:
    """Compile, count and print."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print("Instructions of CartesianToAxes on a named branch, mean of 40 poses (STruC++, g++ -O2, Callgrind)")
    for kind in KINDS:
        if kind.name in GOALS:
            generated, by_hand = _instructions(kind, Path(sys.argv[1]))
            ratio = generated / by_hand
            print(f"{kind.name:14}{generated:7.0f}{by_hand:7.0f}{ratio:7.2f}, at most {GOALS[kind.name]}")
    return 0


def whole(kind: Kind, mechanism: Mechanism) -> str:
    """The text by hand with CartesianToAxes and all checks."""
    text = (FOLDER / f"{kind.by_hand}.st").read_text(encoding="utf-8")
    axes, size = range(len(mechanism.joints)), len(mechanism.branches)
    turning = [k for k in axes if mechanism.joints[k].multi_turn]
    limits = "".join(f"  dLowerA{k + 1} : LREAL;\n  dUpperA{k + 1} : LREAL;\n" for k in axes)
    stored = "".join(f"  {n} : ARRAY[0..5] OF LREAL;\n" for n in ("lowest", "highest", "middle"))
    declared = f"VAR_INPUT\n{limits}END_VAR\nVAR\n  ready : BOOL;\n{stored}  isSingle : ARRAY[0..5] OF BOOL;\nEND_VAR\n"
    text = text.replace("VAR CONSTANT", f"{declared}VAR CONSTANT", 1)
    text = text.replace("END_METHOD", "".join(map(_limited, axes)) + "ready := TRUE;\nEND_METHOD", 1)
    lines = [f"IF {_any(f'cd.abyData[{b}] <> 1' for b in range(size))} THEN RETURN; END_IF"]
    if kind.reads_rotation:
        lines.append("Softkin_ReadMatrix(m := f.mR, aElements := rot, eOrder := Softkin_MatrixOrder.Rows);")
        lines.append(_refused(_within([f"rot[{row}, {column}]" for row in (1, 2, 3) for column in (1, 2, 3)])))
        exact = " AND ".join(f"(ABS({part}) <= 1.0E-13)" for part in _ROTATION)
        lines.append(f"IF NOT ({exact}) THEN IF NOT Softkin_MakeRotation(aElements := rot) THEN RETURN; END_IF END_IF")
    lines.append(_refused(_within([*(f"f.vT.d{c}" for c in "XYZ"), *(f"aRef.a{k}" for k in turning)])))
    for place, k in enumerate(turning, start=size):
        lines += [
            f"turn := Softkin_PeriodOfByte(cd.abyData[{place}]);",
            f"IF turn <> 0 THEN near{k} := 360.0*INT_TO_LREAL(SEL(turn > 0, turn, turn - 1));",
            f"ELSIF isSingle[{k}] THEN near{k} := middle[{k}]; ELSE near{k} := aRef.a{k}; END_IF",
        ]
    given = (", rot := rot" if kind.reads_rotation else "") + (", xTestType2 := TRUE" if kind.type2 else "")
    lines += [f"CartesianToAxes := {_BEYOND};", f"IF NOT Solve(a := found, v := f.vT{given}) THEN RETURN; END_IF"]
    lines += [f"found.a{k} := Softkin_NearestPeriod(found.a{k}, near{k});" for k in turning]
    if kind.name == "SCARA":  # the quill climbs with the turns of A4
        lines.append("found.a2 := f.vT.dZ + pitchPerRadian*(found.a3 - dOffsetA4)/RADIAN + dOffsetA3;")
    inside = " AND ".join(f"(found.a{k} >= lowest[{k}]) AND (found.a{k} <= highest[{k}])" for k in axes)
    lines += [_refused(inside), "a := found;", f"CartesianToAxes := {_NO_ERROR};"]
    head = _HEAD.replace("  turn : INT;", "".join(f"  near{k} : LREAL;\n" for k in turning) + "  turn : INT;")
    return text.replace("END_FUNCTION_BLOCK", head + "\n".join(lines) + "\nEND_METHOD\nEND_FUNCTION_BLOCK", 1)


_HEAD = f"""\
METHOD PUBLIC CartesianToAxes : SMCE
VAR_IN_OUT
  a : AXISPOS_REF;
  f : SMC_Frame;
  aRef : AXISPOS_REF;
  cd : CONFIGDATA;
END_VAR
VAR
  rot : ARRAY[1..3, 1..3] OF LREAL;
  found : AXISPOS_REF;
  turn : INT;
END_VAR
IF NOT ready THEN CartesianToAxes := {_CLOSED}; RETURN; END_IF
CartesianToAxes := {_BAD};
"""


_ROTATION = (
    "rot[1, 1]*rot[1, 1] + rot[2, 1]*rot[2, 1] + rot[3, 1]*rot[3, 1] - 1.0",
    "rot[1, 2]*rot[1, 2] + rot[2, 2]*rot[2, 2] + rot[3, 2]*rot[3, 2] - 1.0",
    "rot[1, 1]*rot[1, 2] + rot[2, 1]*rot[2, 2] + rot[3, 1]*rot[3, 2]",
    "rot[1, 3] + rot[2, 2]*rot[3, 1] - rot[2, 1]*rot[3, 2]",
    "rot[2, 3] + rot[1, 1]*rot[3, 2] - rot[1, 2]*rot[3, 1]",
    "rot[3, 3] + rot[1, 2]*rot[2, 1] - rot[1, 1]*rot[2, 2]",
)
"""What vanishes for a rotation."""


def _limited(k: int) -> str:
    low, high = f"dLowerA{k + 1}", f"dUpperA{k + 1}"
    return (
        f"lowest[{k}] := SEL({low} < {high}, -1.0E300, {low} - 1.0E-9);\n"
        f"highest[{k}] := SEL({low} < {high}, 1.0E300, {high} + 1.0E-9);\n"
        f"isSingle[{k}] := ({low} < {high}) AND ({high} - {low} <= 350.0);\nmiddle[{k}] := 0.5*({low} + {high});\n"
    )


def _any(conditions: Any) -> str:
    return " OR ".join(f"({c})" for c in conditions)


def _within(names: Sequence[str]) -> str:
    return " AND ".join(f"({n} >= -{_LARGE}) AND ({n} <= {_LARGE})" for n in names)


def _refused(allowed: str) -> str:
    return f"IF NOT ({allowed}) THEN RETURN; END_IF"


def _unit(mechanism: Mechanism, by_hand: str) -> str:
    """One text with the types of the controller, the shared objects and both blocks, as STruC++ takes it: without
    pragmas, interfaces, name spaces, constants of a list and constant inputs, and with a matrix of nine numbers.
    """
    given = stubs.texts(31)
    types = given["SM3_Error"].split("TYPE SMC_LANGUAGE")[0]
    types += given["SM3M"][given["SM3M"].index("TYPE SMC_Vector") :].split("{attribute 'native'}")[0]
    types += given["TRAFO"][given["TRAFO"].index("TYPE AXISPOS_REF") :].split("FUNCTION Initialise")[0]
    types = types.replace("0..gciMaxConfigData", "0..31")
    shared = dict(shared_texts())
    names = dict(re.findall(r"^  (\w+) : [\w.]+ := ([\w.]+);", shared["Softkin_Names.st"], re.MULTILINE))
    left_out = {f"{name}.st" for name in (*_UNNEEDED, "Softkin_FindMatrixOrder")}
    text = "\n".join([*(t for n, t in shared.items() if n not in left_out), text_of(mechanism), by_hand])
    text = re.sub(r"\(\*.*?\*\)|//[^\n]*", "", text, flags=re.DOTALL)
    text = re.sub(r" IMPLEMENTS\s+[\w., \n]*?(?=\nVAR)", "", text)
    text = re.sub(r"Softkin_Names\.(\w+)", lambda found: names[found[1]], text)
    text = text.replace("(SIZEOF(m) <> 72) OR ", "").replace("(SIZEOF(copy) <> 72) OR ", "")
    text = text.replace("(SM3M.SMC_MAX_VEC_DIM - 1)", "5").replace("VAR_IN_OUT CONSTANT", "VAR_IN_OUT")
    whole = f"TYPE SMC_Matrix3 : STRUCT e : ARRAY[0..8] OF LREAL; END_STRUCT END_TYPE\n{types}{text}{_ORDER}"
    whole = re.sub(r"\{attribute[^}]*\}|\b(SM3M|SM3_Error|TRAFO)\.", "", whole)
    return whole.replace("SMC_ERROR", "SMCE")


_ORDER = """
FUNCTION Softkin_FindMatrixOrder : Softkin_MatrixOrder
VAR
  unused : INT;
END_VAR
Softkin_FindMatrixOrder := Softkin_MatrixOrder.Rows;
END_FUNCTION
"""


def _with_outputs_left_out(header: str) -> str:
    """The C++ header with a second form of each method whose last outputs a caller may leave out."""

    def added(found: re.Match[str]) -> str:
        indent, result, name, listed = found.groups()
        parameters = listed.split(", ")
        kept = [p for p in parameters if p.split()[-1:] not in (["IREASON"], ["DMISSING"], ["ITURN"])]
        if "<" in listed or kept == parameters:
            return found[0]
        own = "; ".join(p.replace("&", "") for p in parameters[len(kept) :])
        handed = ", ".join(p.split()[-1] for p in parameters)
        return f"{found[0]}\n{indent}{result} {name}({', '.join(kept)}) {{ {own}; return {name}({handed}); }}"

    header = re.sub(r"^( +)virtual (\w+) (\w+)\(((?:[^()]|<[^>]*>)*)\);", added, header, flags=re.MULTILINE)
    return header.replace("namespace strucpp {", "namespace strucpp {\ninline bool NOT(int x) { return !x; }\n", 1)


_MAIN = """\
#include "unit.hpp"
#include <cmath>
#include <cstdio>
using namespace strucpp;
static double P[][18] = {%(rows)s};
template<class B> static void run(B& b) {
  SMC_FRAME f; AXISPOS_REF ref, a; CONFIGDATA cd;
  for (int i = 0; i < %(branches)d; i++) cd.ABYDATA[i] = 1;
  for (int r = 0; r < %(repeats)d; r++) for (auto& p : P) {
    f.VT.DX = p[0]; f.VT.DY = p[1]; f.VT.DZ = p[2];
    for (int j = 0; j < 9; j++) f.MR.E[j] = p[3 + j];
    ref.A0 = p[12]; ref.A1 = p[13]; ref.A2 = p[14]; ref.A3 = p[15]; ref.A4 = p[16]; ref.A5 = p[17];
    int status = (int)(SMCE)b.CARTESIANTOAXES(a, f, ref, cd);
    double v[6] = {a.A0, a.A1, a.A2, a.A3, a.A4, a.A5};
    for (int i = 0; i < 6; i++) if (status || !(std::abs(v[i] - p[12 + i]) < 1e-6)) std::puts("a wrong answer");
  }
}
int main() {
  %(block)s g; %(hand)s h; %(inputs)s
  if ((int)(SMCE)g.INITIALIZE()) std::puts("Initialize refuses");
  h.INITIALIZE(); run(g); run(h);
}
"""


def _instructions(kind: Kind, compiler: Path) -> tuple[float, float]:
    """The instructions of a call, generated and by hand."""
    mechanism = next(m for _, m in catalogue() if m.name == kind.mechanism)
    given = {p.name: p.nominal for p in machine_parameters(mechanism)}
    given |= {j.offset.name: 7.0 * (k + 1) for k, j in enumerate(mechanism.joints)}
    machine = Controller(counting_library({**shared_texts(), file_of(mechanism): text_of(mechanism)}), mechanism)
    assert machine.initialise(given) == OK
    rows = [
        [*position, *(e for row in rotation for e in row), *axes, *[0.0] * (6 - len(axes))]
        for axes, (position, rotation, _) in _poses(kind, mechanism, machine, given)
    ]
    by_hand = whole(kind, mechanism)
    with TemporaryDirectory() as folder:
        work = Path(folder)
        Path(work, "unit.st").write_text(_unit(mechanism, by_hand), encoding="utf-8")
        options = ["-o", f"{work}/unit.cpp", "--no-line-mapping", "--no-default-libs", "-L", str(compiler / "libs")]
        _run(["node", str(compiler / "dist/node/cli.js"), f"{work}/unit.st", *options])
        header = Path(work, "unit.hpp")
        header.write_text(_with_outputs_left_out(header.read_text(encoding="utf-8")), encoding="utf-8")
        values = {"rows": ", ".join("{" + ", ".join(map(repr, map(float, row))) + "}" for row in rows)}
        values |= {"block": mechanism.block_name.upper(), "hand": kind.by_hand.upper()}
        values["inputs"] = _assignments(mechanism, by_hand, given)
        main = _MAIN % {**values, "branches": len(mechanism.branches), "repeats": _REPEATS}
        Path(work, "main.cpp").write_text(main, encoding="utf-8")
        sources = [f"{work}/unit.cpp", f"{work}/main.cpp", f"-I{compiler}/src/runtime/include", f"-I{work}"]
        _run(["g++", "-g", "-std=c++17", "-O2", "-fpermissive", "-w", *sources, "-o", f"{work}/run"])
        wrong = _run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={work}/counts", f"{work}/run"])
        assert not wrong, wrong
        told = _run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", f"{work}/counts"])
    names = "SOFTKIN_KINEMATICS", kind.by_hand.upper()
    found = (re.findall(rf"^ *([\d,]+) \(.*{name}::CARTESIANTOAXES", told, re.MULTILINE) for name in names)
    generated, hand = (max(int(number.replace(",", "")) for number in some) for some in found)
    return generated / len(rows) / _REPEATS, hand / len(rows) / _REPEATS


def _assignments(mechanism: Mechanism, by_hand: str, given: dict[str, Any]) -> str:
    """The inputs of both blocks in C++."""
    lines: list[str] = []
    for letter, text in (("g", text_of(mechanism)), ("h", by_hand)):
        inputs = set(re.findall(r"^  (\w+) : (?:LREAL|BOOL|INT)\b", text.split("\nMETHOD")[0], re.MULTILINE))
        for parameter in machine_parameters(mechanism):
            name, value = wanted_name(parameter), given[parameter.name]
            if name in inputs:
                spelled = str(bool(value)).lower() if name.startswith("x") else repr(float(value))
                lines.append(f"{letter}.{name.upper()} = {spelled};")
    return " ".join(lines)


def _run(command: Sequence[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


if __name__ == "__main__":
    sys.exit(main())
