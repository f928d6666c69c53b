"""The setup program for languages without a base block: its statements, and the parameters that it reads.

Two steps are the same for every machine, and stand in the runtime of a language: the table of parameters tests the
range of each parameter, and one call for each axis computes its range of motion.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace

from derive.description.mechanism import Parameter
from derive.emit.inputs import Inputs
from derive.emit.interface import read_by
from derive.equations.windows import Window, windows
from derive.ir.program import Let, Output, Program, Require, Solve, Statement
from derive.ir.symbols import symbols_of
from derive.kinematics.kinematics import Kinematics
from derive.kinematics.parameters import ranges


@dataclass(frozen=True)
class Setup:
    """What a language writes of the setup program."""

    program: Program
    windows: tuple[Window, ...]

    def steps(self) -> Iterator[Window | Require | Let | Solve]:
        """The statements in their order; in place of the refusal of the limits of an axis, its range of motion."""
        by_refusal = {window.refusal: window for window in self.windows}
        for statement in self.program.body:
            if not isinstance(statement, Require | Let | Solve):
                raise TypeError("what depends on parameters alone is straight-line: it neither iterates nor calls")
            window = None
            if isinstance(statement, Require) and statement.reason is not None:
                window = by_refusal.get(statement.reason)
            yield statement if window is None else window

    def outputs(self) -> list[Output]:
        """The constants that are no ends of a range of motion."""
        ends = {o.name for window in self.windows for o in window.outputs}
        return [o for o in self.program.outputs if o.name not in ends]

    def parameters(self, kin: Kinematics) -> list[Parameter]:
        """The parameters that it reads, except the limits that it passes to the runtime."""
        values = [o.value for o in self.program.outputs]
        values += [e for window in self.windows for e in (window.turns, *(e for f in window.fallback for e in f))]
        symbols = {s for value in values for s in symbols_of(value)}
        symbols |= {s for step in self.steps() if not isinstance(step, Window) for s in step.reads()}
        names = {s.name for s in symbols}
        return [p for p in kin.parameters if p.name in names]


def setup_of(kin: Kinematics, read: Collection[str]) -> Setup:
    """The setup program for a machine whose other functions read these constants."""
    return Setup(_own_setup(kin, read), tuple(windows(kin.mechanism)))


def _own_setup(kin: Kinematics, read: Collection[str]) -> Program:
    """The setup program without the steps of the runtime, and without values that no program reads."""
    tested = ranges(kin.parameters)
    elsewhere = {let.name for window in windows(kin.mechanism) for let in (*window.limits, *window.ends)}
    outputs = tuple(o for o in kin.setup.outputs if o.name in read)
    wanted = {s for o in outputs for s in symbols_of(o.value)}
    body: list[Statement] = []
    for statement in reversed(kin.setup.body):
        bound = set(statement.bound())
        if statement.reason not in tested if isinstance(statement, Require) else bound & wanted - elsewhere:
            wanted |= statement.reads()
            body.append(statement)
    return replace(kin.setup, body=tuple(reversed(body)), outputs=outputs)


def with_constants(program: Program, kin: Kinematics, known: Collection[str]) -> Program:
    """The program with the statements of the setup program in front that compute the constants which are not known."""
    constants = read_by(program) - set(known)
    if not constants:
        return program
    before = [s for s in setup_of(kin, constants).program.body if not isinstance(s, Require)]
    return replace(program, body=(*before, *program.body))


def refused_inputs(require: Require, inputs: Inputs) -> tuple[str, list[str]]:
    """The sentence that refuses parameters, and their names in the language."""
    assert require.reason is not None
    read = {s.name for s in require.condition.free_symbols}
    return inputs.reworded(require.reason.subject.name), [name for inner, name in inputs.names.items() if inner in read]
