"""The effort of a call of the self-test: the largest number of its floating operations.

Without a loop these are the bounds in the header of the block. A loop is counted as often as the reference interpreter
ran it for this call, plus a fifth, because the block examines roots in another order.
"""

from __future__ import annotations

from dataclasses import replace

from derive.ir.interpret import Repeats
from derive.kinematics.reference_cases import Called, Case
from derive.report.cost import Cost, cost_of, costs_of
from derive.report.reference_calls import Machine, forward_counted, inverse_counted

_OF_THE_TEST = 120
"""The operations of the self-test itself in a cycle: it finds the order of a matrix, and compares numbers."""
_MORE = 1.2
"""A block may need this many times the trials or passes of the reference."""
_OPEN = (0, 3)


def with_operations(case: Case, machine: Machine) -> Case:
    """The case with its operations."""
    return replace(case, operations=_OF_THE_TEST + sum(_cost(case, machine).counts))


def _cost(case: Case, machine: Machine) -> Cost:
    kinematics = machine.kinematics
    if case.called is Called.INITIALIZE:
        return cost_of(kinematics.setup)
    if case.called is Called.SINGULARITY:
        return cost_of(kinematics.singularity)
    costs = costs_of(kinematics)
    most, ran = _loops(case, machine) if costs.bounds else (Cost(), Cost())
    if case.called is Called.FORWARD:
        return costs.forward + most * -1 + ran
    slots = 1 << sum(byte in _OPEN for byte in case.configuration[: len(kinematics.branches)])
    one = costs.inverse if slots == 1 else costs.tried
    whole: Cost = (one + costs.corners + most * -1) * slots + ran + costs.repair + costs.limits
    return whole


def _loops(case: Case, machine: Machine) -> tuple[Cost, Cost]:
    """The cost of the loops of a call: the largest possible one, and that of the reference interpreter plus a fifth."""
    is_forward = case.called is Called.FORWARD
    program = machine.kinematics.forward if is_forward else machine.kinematics.branch
    if is_forward:
        repeats = forward_counted(machine, case.axes)[1]
    else:
        repeats = inverse_counted(machine, case.frame, case.configuration, case.reference)[1]
    ran = Repeats(*(int(_MORE * n) for n in (repeats.trials, repeats.finished, repeats.passes)))
    once = cost_of(program, repeats=Repeats()) * -1
    return cost_of(program) + once, cost_of(program, repeats=ran) + once
