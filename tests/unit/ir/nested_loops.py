"""A loop whose step calls a program that loops itself: in three levels, and the answers of every language.

find_root   Heron's method for a square root
find_mean   the arithmetic-geometric mean: each pass needs a root, until both numbers agree
settle      the mean of a number and a second one, again and again, until it is the second one
"""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import softkin
import sympy as sp
from softkin import _array, _scalar

from derive.emit.braced import indented
from derive.emit.c import package as c_package
from derive.emit.c.functions import Function as CFunction
from derive.emit.c.program import function_lines as c_lines
from derive.emit.interface import Entry
from derive.emit.javascript import package as javascript_package
from derive.emit.javascript.functions import Function as JavaScriptFunction
from derive.emit.javascript.program import function_lines as javascript_lines
from derive.emit.javascript.program import refusals_of
from derive.emit.language import environment
from derive.emit.python.arrays import array_body
from derive.emit.python.program import Argument, Method, scalar_body
from derive.emit.st.contract import Parameter, Signature, load
from derive.emit.st.layout import assigned
from derive.emit.st.names import parameter_name
from derive.emit.st.program import printed
from derive.emit.st.refusal import Refusal
from derive.emit.st.shared import method_name, own_names
from derive.ir.interpret import run
from derive.ir.passes import hoist, normalise
from derive.ir.primitives import ToReal
from derive.ir.program import Call, Iterate, Let, Output, Program, Require, Status, shared
from derive.ir.reason import Why, about_machine
from derive.ir.symbols import count, real
from derive.lowering.passes import lowered
from derive.report.reasons import Reasons
from tests import outside
from tests.c.programs import compile_in, written
from tests.harness.library import compile_st
from tests.javascript.node import run as run_in_node
from tests.text.units import shared_texts

TINY, CLOSE, RADICAND, GUESS, CHANGE, ROOT = map(real, ("tiny", "close", "radicand", "guess", "change", "root"))
FIRST, SECOND, MEAN, OTHER, HALF, TAKEN = map(real, ("first", "second", "mean", "other", "half", "taken"))
BEGIN, END, LEVEL, SUM, PASSES = *map(real, ("begin", "end", "level", "sum")), count("passes")
NONE = about_machine(Why.NO_ROOT)


def find_root() -> Program:
    """Refuses a number that is not positive, and one whose root is too far away."""
    loop = Iterate(
        state=(GUESS,),
        start=((1 + RADICAND) / 2,),
        step=(Let(CHANGE, (RADICAND / GUESS - GUESS) / 2),),
        following=(GUESS + CHANGE,),
        done=sp.Le(sp.Abs(CHANGE), CLOSE * GUESS),
        limit=60,
        otherwise=Status.IMPOSSIBLE,
        note="Heron's method",
        reason=NONE,
    )
    positive = Require(sp.Gt(RADICAND, 0), Status.BAD_INPUT, reason=NONE)
    return normalise("find_root", (Let(CLOSE, TINY / 2), positive, loop), [Output("root", GUESS + CHANGE)])


def find_mean(passes: int | None = None) -> Program:
    """Calls for the root only where both numbers differ; a count is part of the state."""
    differ, agree = (kind(sp.Abs(MEAN - OTHER), TINY * MEAN) for kind in (sp.Gt, sp.Le))
    loop = Iterate(
        state=(MEAN, OTHER, PASSES),
        start=(FIRST, SECOND, sp.Integer(1)),
        step=(
            Let(HALF, (MEAN + OTHER) / 2),
            Call(find_root(), ((RADICAND, MEAN * OTHER),), (ROOT,), wanted=differ, passes=passes),
        ),
        following=(HALF, ROOT, PASSES + 1),
        done=agree,
        limit=12,
        otherwise=Status.UNREACHABLE,
        note="both means",
        reason=NONE,
    )
    return normalise("find_mean", (loop,), [Output("mean", MEAN), Output("taken", ToReal(PASSES))])


def settle() -> Program:
    """Reads the results of its calls behind the loop as well, and has its own refusal where they refuse."""
    given = ((FIRST, LEVEL), (SECOND, END))
    call = Call(find_mean(), given, (MEAN, TAKEN), refusal=(Status.INVALID_COUPLING, NONE))
    done = sp.Le(sp.Abs(MEAN - LEVEL), sp.Float("1e-9") * END)
    loop = Iterate((LEVEL, SUM), (BEGIN, sp.Integer(0)), (call,), (MEAN, SUM + TAKEN), done, 60, None, "levels")
    return normalise("settle", (loop,), [Output("level", MEAN), Output("sum", SUM + TAKEN)])


def programs() -> tuple[Program, ...]:
    """As every language gets them: each behind those that it calls, with the constant hoisted, and in short."""
    whole, first = hoist((*shared([settle()]), settle()), ["tiny"])
    assert [let.name for let in first] == [CLOSE]
    found, second = lowered(whole, CONSTANTS)
    assert not second
    return found


CONSTANTS = {"tiny": 1e-12, "close": 5e-13}
PROGRAMS = {program.name: program for program in programs()}
ROWS = [(24.0, 6.0), (1.0, 2**0.5), (3.0, 3.0), (1e-3, 1e3), (-1.0, -4.0), (1e80, 1.0), (0.0, 1.0)]
Answers = list[tuple[str, list[float]]]


def arguments(program: Program) -> tuple[str, ...]:
    return tuple(s.name for s in program.inputs if s.name not in CONSTANTS)


def interpreted(name: str, rows: Sequence[Sequence[float]] = ROWS) -> Answers:
    program = PROGRAMS[name]
    columns = dict(zip(arguments(program), np.array(rows).T, strict=True))
    outputs, status = run(program, columns | {n: np.array(v) for n, v in CONSTANTS.items()})
    return [(s.name, [float(v[k]) for v in outputs.values()]) for k, s in enumerate(status)]


def in_python(name: str) -> Answers:
    found = []
    machine = made_of("_", "given", scalar_body, vars(_scalar))
    for row in ROWS:
        answer = getattr(machine, f"_{name}")(row)
        found.append((answer.name, []) if isinstance(answer, softkin.Status) else ("OK", list(answer)))
    return found


def in_arrays(name: str) -> Answers:
    own = ("machine = None", "run_where = Programs.run_where")
    machine = made_of("", "given, status", array_body, vars(_array), own)
    status = np.zeros(len(ROWS), np.uint8)
    with np.errstate(all="ignore"):
        columns = getattr(machine, name)(tuple(np.array(ROWS).T), status)
    return [(softkin.Status(s).name, [float(c[k]) for c in columns]) for k, s in enumerate(status)]


def made_of(
    prefix: str, given: str, body: Callable[[Method], list[str]], names: Mapping[str, Any], own: Sequence[str] = ()
) -> Any:
    lines = ["class Nested:", *indented(["constants = _constants = known", *own])]
    for name, program in PROGRAMS.items():
        result = tuple(o.name for o in program.outputs)
        method = Method(name, "", program, (Argument("given", "Values", arguments(program)),), "Values", result, True)
        lines += indented([f"def {prefix}{name}(self, {given}):", *indented(body(method))])
    space = {**names, "Status": softkin.Status, "known": SimpleNamespace(**CONSTANTS)}
    exec("\n".join(lines), space)
    return space["Nested"]()


def entries() -> list[Entry]:
    return [
        Entry("", "", p, (("given", arguments(p)),), (("found", tuple(o.name for o in p.outputs)),))
        for p in PROGRAMS.values()
    ]


def in_c(name: str) -> Answers:
    functions = [CFunction(entry) for entry in entries()]
    texts = [line for f in functions for line in c_lines(f, "nested", {n: f"k->{n}" for n in CONSTANTS}, Reasons({}))]
    called = next(f.name for f in functions if f.program.name == name)
    text = [
        '#include "softkin.h"', "#include <math.h>", "#include <stdio.h>",
        "typedef struct { double tiny, close; } nested;", *texts,
        "int main(void) {", "  const nested machine = {1e-12, 5e-13};", "  double given[2], found[2];",
        '  while (scanf("%lf %lf", given, given + 1) == 2) {', "    found[0] = found[1] = 0.0;",
        f"    const int status = (int){called}(&machine, given, found, NULL);",
        '    printf("%d %.17g %.17g\\n", status, found[0], found[1]);', "  }", "  return 0;", "}", "",
    ]  # fmt: skip
    folder = written({**c_package.files([]), "nested.c": "\n".join(text)})
    compile_in(folder, "-Wno-unused-function", "nested.c", "softkin.c", "-lm", "-o", "nested")
    rows = "\n".join(f"{a!r} {b!r}" for a, b in ROWS)
    answers = [line.split() for line in outside.output_of([folder / "nested"], input=rows).splitlines()]
    return [(softkin.Status(int(status)).name, list(map(float, values))) for status, *values in answers]


def in_javascript(name: str, folder: Path) -> Answers:
    functions = [JavaScriptFunction(entry) for entry in entries()]
    lines = [line for f in functions for line in javascript_lines(f, refusals_of(Reasons({})))]
    called = next(f.name for f in functions if f.program.name == name)
    outside.written(javascript_package.files([]), folder)
    head = 'import { Refusal, Status, refuse } from "./softkin/softkin.js";'
    (folder / "nested.js").write_text("\n".join([head, *lines, f"export {{ {called}, Refusal }};"]), encoding="utf-8")
    asked = f"{list(map(list, ROWS))}.map((row) => module.{called}({CONSTANTS}, row))"
    script = f"return {asked}.map((one) => (one instanceof module.Refusal ? one.status : one));"
    answers = run_in_node(folder / "nested.js", script)
    return [(softkin.Status(a).name, []) if isinstance(a, int) else ("OK", a) for a in answers]


def in_structured_text(name: str) -> Answers:
    contract = load()
    error, errors = contract.spelling["types"]["error"], contract.spelling["errors"]
    templates, methods, constants = environment("st"), [], {name: name for name in CONSTANTS}
    templates.globals["assigned"] = assigned
    template = templates.get_template("methods/Shared.st.j2")
    for program in PROGRAMS.values():
        own = own_names(program, constants)
        given = [Parameter("VAR_INPUT", own[n], "LREAL") for n in arguments(program)]
        results = [Parameter("VAR_OUTPUT", own[o.name], "LREAL") for o in program.outputs]
        signature = Signature(method_name(program), error, (*given, *results))
        stored = {o.name: own[o.name] for o in program.outputs}
        body = printed(program, {**constants, **own}, stored, (), Refusal(signature, errors, error))
        names = [(own[o], text) for o, text in body.outputs.items() if own[o] != text]
        known = {**contract.spelling, "method": signature.name, "program": body, "results": names}
        methods += [signature.head(), template.render(known), "END_METHOD"]
    variables = [f"{name} : LREAL := {value / 1e-12}E-12;" for name, value in CONSTANTS.items()]
    text = "\n".join(["FUNCTION_BLOCK Nested", "VAR", *variables, "END_VAR", *methods, "END_FUNCTION_BLOCK"])
    block = compile_st({**shared_texts(), "Nested.st": text}).new("Nested")
    program, found = PROGRAMS[name], []
    for row in ROWS:
        named = {parameter_name(n): v for n, v in zip(arguments(program), row, strict=True)}
        status, outputs = block.call_with_outputs(method_name(program), **named)
        found.append((Status(status).name, [outputs[parameter_name(o.name)] for o in program.outputs]))
    return found


LANGUAGES: dict[str, Callable[..., Answers]] = {
    "the interpreter": interpreted, "Python": in_python, "Python on arrays": in_arrays, "C": in_c,
    "JavaScript": in_javascript, "Structured Text": in_structured_text,
}  # fmt: skip


def answers(language: str, name: str, folder: Path) -> Answers:
    return in_javascript(name, folder) if language == "JavaScript" else LANGUAGES[language](name)
