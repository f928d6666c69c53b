"""The constants of the compiler that the runtimes of Python, C and JavaScript read: they state none themselves."""

from __future__ import annotations

from derive.ir import cells, constants, roots
from derive.ir.program import Status

NUMBERS = {
    **{name.lower(): float(vars(constants)[name]) for name in (
        *("EDGE", "FREE_ANGLE", "GEARED_TURN", "HELD", "LARGEST", "LEAST", "LIMIT"),
        *("ONE_TURN", "PIVOT", "SINGULAR", "SOLVABLE", "TIE", "UNLIMITED"),
    )},
    "exact": float(constants.EXACT_ROTATION),
    "largest_error": float(constants.ROTATION),
}  # fmt: skip
"""The bounds and tolerances, by their names in the runtimes, in small letters."""
COUNTS = {"trials": constants.TRIALS, "finished": constants.FINISHED}
"""The bounds of iterations, which are written as they are."""
OF_THE_SEARCH: dict[str, float | tuple[float, ...]] = {
    name: (vars(cells) | vars(roots))[name] for name in (
        *("AHEAD", "ASIDE", "BENT", "CELLS", "CLOSING", "FINEST", "FLAT", "GAP", "NARROW", "NEAR_ZERO"),
        *("NEXT", "RESERVE", "RIM", "SEAM", "SHIFTS", "TOUCHED", "TURNED", "VANISHING"),
    )
}  # fmt: skip
"""The constants of the root search."""
_MEANINGS = {
    Status.OK: "no error",
    Status.NOT_INITIALIZED: "a parameter is not allowed",
    Status.BAD_INPUT: "numbers must be finite and at most 1e9 in size, and a rotation must be one",
    Status.UNREACHABLE: "out of reach or beyond a limit",
    Status.IMPOSSIBLE: "the mechanism cannot be assembled there, or a joint is undetermined",
    Status.INVALID_COUPLING: "this pair of position and orientation kinematics is impossible",
}
STATUSES = [{"name": s.name, "softmotion": s.value, "meaning": _MEANINGS[s]} for s in Status]
"""The statuses in their order, with their names in SoftMotion."""
