"""A condition that a refusal has decided is not tested again, where a program ends at its first refusal.

require(length > tolerance)
divisor = select(length > tolerance, length, 1)      →  length is read where divisor was
"""

from __future__ import annotations

from dataclasses import replace
from operator import is_

import sympy as sp

from derive.ir.passes import with_inputs
from derive.ir.program import Let, Output, Program, Require, Statement, rewritten
from derive.ir.symbols import names_in


def decided(program: Program) -> Program:
    """The program for a language that returns where a condition does not hold."""
    known: dict[sp.Basic, sp.Basic] = {}
    about: set[sp.Symbol] = set()  # the names in the known conditions: an expression without any of them stays
    body: list[Statement] = []

    def read(expression: sp.Basic) -> sp.Basic:
        return expression if about.isdisjoint(names_in(expression)) else expression.xreplace(known)

    for statement in program.body:
        changed = rewritten(statement, read)
        if isinstance(changed, Let) and changed is not statement and changed.value.is_Symbol:
            known[changed.name] = changed.value
            about.add(changed.name)
            continue
        if isinstance(changed, Require):
            if changed.condition == sp.true:
                continue
            known |= dict.fromkeys(sp.And.make_args(changed.condition), sp.true)
            about |= names_in(changed.condition)
        body.append(changed)
    outputs = tuple(Output(o.name, read(o.value)) for o in program.outputs)
    if len(body) == len(program.body) and all(map(is_, body, program.body)) and outputs == program.outputs:
        return program
    return with_inputs(replace(program, body=tuple(body), outputs=outputs))
