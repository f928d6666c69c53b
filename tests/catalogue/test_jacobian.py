"""The Jacobian against the derivative of the closure; its determinant against the margins."""

import numpy as np

from derive.description.mechanism import Mechanism, Turning
from tests.catalogue.closure import Array
from tests.catalogue.machines import REGULAR, Machine, few

ROUNDING = 1e-12
TURNS = {
    Turning.NONE: (),
    Turning.ABOUT_Z: ("turn z",),
    Turning.DIRECTION: ("tilt x", "tilt y"),
    Turning.PITCH: ("pitch",),
    Turning.FULL: ("turn x", "turn y", "turn z"),
}


def jacobians(machine: Machine, axes: Array) -> Array:
    """The Jacobians that the package computes one by one."""
    return np.array([machine.robot.jacobian(row) for row in axes])


def scaled(machine: Machine, matrices: Array) -> Array:
    """Lengths measured in reaches: rows of positions and columns of linear axes."""
    rows = np.array([1.0 if r.startswith(("turn", "tilt")) else machine.reach for r in machine.robot.JACOBIAN_ROWS])
    columns = np.where(machine.closure.angles, 1.0, machine.reach)
    return matrices / rows[:, None] * columns


def of_solved(machine: Machine, axes: Array) -> Array:
    """The scaled columns of the joints that the inverse solves for: a held one makes no pose regular."""
    return scaled(machine, jacobians(machine, axes))[:, :, machine.solved]


def margins(machine: Machine, axes: Array) -> Array:
    """The margins at axis values, a column each."""
    found = [machine.robot.singularity(row).margins for row in axes]
    return np.array([[m[name] for name in machine.robot.MARGINS] for m in found])


def factors(machine: Machine, axes: Array) -> Array:
    """The margins; a machine without lengths says 1 of a distance, and the distance itself is the factor."""
    found = margins(machine, axes)
    joints = machine.closure.joints(axes)
    for column, name in enumerate(machine.robot.MARGINS):
        if name.startswith("free") and (found[:, column] == 1.0).all():
            positive = set(machine.mechanism.positive)
            (place,) = (i for i, j in enumerate(machine.mechanism.joints) if not j.is_angle and j.symbol in positive)
            found[:, column] = joints[:, place]
    return found


def exponents(machine: Machine, axes: Array) -> Array:
    """How often each margin is a factor of the determinant: log |det J| = c + sum of e log |margin|."""
    determinants = np.abs(np.linalg.det(of_solved(machine, axes)))
    design = np.hstack([np.log(np.abs(factors(machine, axes))), np.ones((len(axes), 1))])
    return np.linalg.lstsq(design, np.log(determinants), rcond=None)[0][:-1]


def test_rows_are_the_task(mechanism: Mechanism, machines: tuple[Machine, ...]) -> None:
    assert (*mechanism.task.position, *TURNS[mechanism.task.turning]) == machines[0].robot.JACOBIAN_ROWS


def test_it_is_the_derivative_of_the_closure(machines: tuple[Machine, ...]) -> None:
    for machine in machines:
        axes = machine.draw(60, np.random.default_rng(1))
        expected = machine.closure.jacobian(axes, machine.closure.poses(axes)[0])
        slack = 5.0 if machine.mechanism.drives else 1.0  # next to dead points loops enlarge rounding
        assert np.abs(scaled(machine, jacobians(machine, axes) - expected)).max() < slack * ROUNDING


def test_the_determinant_is_the_product_of_the_margins(machines: tuple[Machine, ...]) -> None:
    """With whole exponents, and with its sign: crossing a margin of odd exponent turns the determinant round."""
    for machine in few(machines):
        axes = machine.draw(60, np.random.default_rng(4))
        found = exponents(machine, axes)
        whole = np.round(found)
        assert np.abs(found - whole).max(initial=0.0) < 1e-8
        expected = [-1.0 if _is_type_2(machine, name) else 1.0 for name in machine.robot.MARGINS]
        assert (np.sign(whole) == expected).all()
        products = np.prod(factors(machine, axes) ** whole, axis=1)
        ratio = np.linalg.det(of_solved(machine, axes)) / products
        assert np.ptp(ratio) < 1e-9 * np.abs(ratio[0])


def _is_type_2(machine: Machine, margin: str) -> bool:
    """Where it vanishes the determinant of a closed loop grows without bound."""
    if machine.mechanism.drives:
        return margin.startswith("lever_")
    assembly = machine.mechanism.assembly
    if machine.mechanism.is_platform:
        return margin == "rods_dependent"
    return assembly is not None and margin == assembly.margin


def test_branch_margins_are_the_indicators(machines: tuple[Machine, ...]) -> None:
    """In sign, and in size where the indicator is a sine; a length is scaled by what depends on parameters alone."""
    for machine in few(machines):
        axes = machine.draw(60, np.random.default_rng(5))
        indicators = machine.closure.indicators(machine.closure.joints(axes))
        for i, branch in enumerate(machine.mechanism.branches):
            column = machine.robot.MARGINS.index(branch.margin)
            found = margins(machine, axes)[:, column]
            is_length = bool(machine.mechanism.rods) or machine.largest[i] != 1.0
            constant = indicators[0, i] / found[0] if is_length else 1.0
            assert constant > 0.0
            assert np.abs(found * constant - indicators[:, i]).max() < ROUNDING / REGULAR * np.abs(indicators).max()
