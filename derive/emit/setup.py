"""The setup program for languages without a base block: its statements, and the parameters that it reads.

Two steps are the same for every machine, and stand in the runtime of a language: the table of parameters tests the
range of each parameter, and one call for each axis computes its range of motion.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from derive.description.mechanism import Parameter
from derive.equations.windows import Window, windows
from derive.ir.program import Program, Require, Statement, binds, reads
from derive.ir.symbols import symbols_of
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import ranges


def own_setup(kin: Kinematics, read: Collection[str]) -> Program:
    """The setup program without the steps of the runtime, and without values that no program reads."""
    tested = ranges(kin.parameters)
    elsewhere = {let.name for window in windows(kin.mechanism) for let in (*window.limits, *window.ends)}
    outputs = tuple(o for o in kin.setup.outputs if o.name in read)
    wanted = {s for o in outputs for s in symbols_of(o.value)}
    body: list[Statement] = []
    for statement in reversed(kin.setup.body):
        bound = set(binds(statement))
        if statement.reason not in tested if isinstance(statement, Require) else bound & wanted - elsewhere:
            wanted |= reads(statement)
            body.append(statement)
    return replace(kin.setup, body=tuple(reversed(body)), outputs=outputs)


def parameters_read(kin: Kinematics, program: Program, found: Collection[Window]) -> list[Parameter]:
    """The parameters that the setup program reads, except the limits that it passes to the runtime."""
    refusals = {window.refusal for window in found}
    values = [o.value for o in program.outputs] + [e for window in found for f in window.fallback for e in f]
    symbols = {s for value in values for s in symbols_of(value)}
    symbols |= {s for window in found for s in symbols_of(window.turns)}
    for statement in program.body:
        if not (isinstance(statement, Require) and statement.reason in refusals):
            symbols |= reads(statement)
    names = {s.name for s in symbols}
    return [p for p in kin.parameters if p.name in names]
