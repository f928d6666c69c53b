"""The independent witness: every derived program is measured against the closure equations themselves.

CasADi functions are built from a mechanism's description as it is written, never from a derived formula, nor from what
the compiler makes of the description before it derives. They give the residual, the Jacobian by automatic
differentiation, and the number of solutions by multi-start root finding.

It imports descriptions, programs and the bundle `kinematics.kinematics`, and nothing of the derivation.

checks: the checks of forward kinematics, Jacobian and margins, and how errors are measured
closure: the closure equations as CasADi functions
disagreement: the errors if a derived formula is wrong, and if there is no pose to measure
exact/: forward and inverse kinematics against the closure in a finite field, where it holds or not
frames: the frames of a chain, multiplied out factor by factor; CasADi functions over rows of samples
home_samples: axis values of a loop that turns its platform, around its home pose
inverse: the checks of the inverse: every slot, the way back, no solution missing; the assembly mode of a platform
onward: all solutions of a searched arm, one after the other
orientation: the check of the orientations that a flange can have
planted: poses close to where branches of a root search meet
roots: all solutions of the closure for a pose, from many starts
samples: machines and regular poses, drawn from a fixed seed
surplus: axis values at which surplus rods fit the pose of the others
"""

from __future__ import annotations

import math

from derive.description.mechanism import Mechanism
from derive.kinematics.kinematics import Evidence, Inverted, Kinematics
from derive.witness.checks import check_bias, check_forward, check_jacobian, check_margins, check_signs
from derive.witness.closure import closure_of
from derive.witness.disagreement import Disagreement, NoPose
from derive.witness.exact.proof import check_exactly
from derive.witness.inverse import all_slots, check_inverse, check_offset, check_solutions
from derive.witness.orientation import check_jointless, check_orientation
from derive.witness.samples import regular_samples
from derive.work import stage

__all__ = ["Disagreement", "NoPose", "witness"]

_FLOOR = 1e-12


@stage("the measurement against its equations")
def witness(kin: Kinematics, described: Mechanism) -> Evidence:
    """Measure every program of a mechanism against the closure of its description, as it is written; raises
    `Disagreement` where one contradicts it.
    """
    try:
        closure = closure_of(described, kin.mechanism)
        if not kin.mechanism.joints:
            poses, error = check_jointless(kin, closure)
            return Evidence(poses, decade(error), None, check_exactly(kin, described))
        samples = regular_samples(kin, closure)
        forward = check_forward(kin, closure, samples)
        jacobian = check_jacobian(kin, closure, samples)
        check_bias(kin, closure, samples)
        if described.nominal is None:
            forward = max(forward, check_orientation(kin, samples))
            check_margins(kin, closure, samples)
        else:  # margins, and what the flange can do, are those of the drawing, which is proven by itself
            check_signs(kin, closure, samples)
        slots = all_slots(kin, samples)
        inverse, round_trip = check_inverse(kin, closure, samples, slots)
        offset, offset_trip = check_offset(kin, closure, samples)
        solutions, missed = check_solutions(kin, closure, samples, slots)
        exact = check_exactly(kin, described)
    except Disagreement as problem:
        raise type(problem)(f"{kin.mechanism.name}: {problem}") from None
    return Evidence(
        poses=len(samples),
        closure_residual=decade(max(forward, inverse, offset)),
        inverted=Inverted(decade(max(round_trip, offset_trip)), decade(jacobian), solutions, missed),
        exact=exact,
    )


def decade(measured: float) -> float:
    """The next power of ten, from 1e-12 up: the same on every computer in spite of rounding."""
    return float(f"1e{math.ceil(math.log10(max(measured, _FLOOR)) - 1e-9)}")
