"""The cost of one call: of the worst with every branch named, and of the cases of a self-test."""

from __future__ import annotations

from dataclasses import replace

from derive.ir.one_row import Repeats
from derive.kinematics.kinematics import Called, Case, Kinematics
from derive.report.cost import Cost, cost_of, costs_of
from derive.report.reference_calls import Machine, forward_counted, inverse_counted

_OF_THE_TEST = 120
"""The operations of the self-test itself in a cycle: it finds the order of a matrix, and compares numbers."""
_MORE = 1.2
"""A block may need this many times the operations of the reference."""
_OPEN = (0, 3)


def with_operations(case: Case, machine: Machine) -> Case:
    """The case with its operations, the largest number in this call, and its budget.

    Without a loop these are the bounds in the header of the block. A loop is counted as often as the reference
    interpreter ran it for this call. The budget is larger by a fifth: the block examines roots in another order,
    but by no more than the loops may run.
    """
    most = sum(_largest(case, machine.kinematics).counts)
    counted = most - sum(_spared(case, machine).counts) if costs_of(machine.kinematics).bounds else most
    return replace(case, operations=counted, budget=_OF_THE_TEST + min(most, int(_MORE * counted)))


def worst_inverse(kinematics: Kinematics) -> Cost:
    """The inverse with a configuration that names every branch, at a singular pose, with a frame to be repaired."""
    costs = costs_of(kinematics)
    return costs.inverse + costs.corners + costs.repair


def open_slots(case: Case, kinematics: Kinematics) -> int:
    """The number of branches that a call of the inverse tries."""
    return 1 << sum(byte in _OPEN for byte in case.configuration[: len(kinematics.branches)])


def _largest(case: Case, kinematics: Kinematics) -> Cost:
    """The cost of the call if every loop of it ran as often as it may."""
    costs = costs_of(kinematics)
    if case.called is Called.INITIALIZE:
        return cost_of(kinematics.setup)
    if case.called is Called.SINGULARITY:
        return cost_of(kinematics.singularity)
    if case.called is Called.FORWARD:
        return costs.forward
    slots = open_slots(case, kinematics)
    if slots == 1:
        return worst_inverse(kinematics)
    return (costs.tried + costs.corners) * slots + costs.repair + costs.limits


def _spared(case: Case, machine: Machine) -> Cost:
    """What a call costs less because its loops end before their bounds."""
    kinematics = machine.kinematics
    if case.called is Called.FORWARD:
        ran, program, runs = forward_counted(machine, case.axes)[1], kinematics.forward, 1
    elif case.called is Called.INVERSE:
        ran = inverse_counted(machine, case.frame, case.configuration, case.reference)[1]
        program, runs = kinematics.branch, open_slots(case, kinematics)
    else:
        return Cost()
    once = cost_of(program, repeats=Repeats())
    return (cost_of(program) + once * -1) * runs + (cost_of(program, repeats=ran) + once * -1) * -1
