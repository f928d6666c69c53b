"""The constants of the compiler that the runtimes of Python, C and JavaScript read: they state none themselves."""

from __future__ import annotations

from derive.ir import cells, constants, roots
from derive.ir.program import Status

_NUMBERS = {
    **{name: float(vars(constants)[name]) for name in (
        *("COINCIDENT", "EDGE", "GEARED_TURN", "HELD", "LARGEST", "LEAST", "LIMIT"),
        *("ONE_TURN", "PIVOT", "SINGULAR", "SOLVABLE", "TIE", "UNLIMITED"),
    )},
    "EXACT": float(constants.EXACT_ROTATION),
    "LARGEST_ERROR": float(constants.ROTATION),
    "TRIALS": constants.TRIALS,
    "FINISHED": constants.FINISHED,
}  # fmt: skip
"""Bounds, tolerances, and bounds of iterations."""
_OF_THE_SEARCH = {
    name: (vars(cells) | vars(roots))[name] for name in (
        *("AHEAD", "ASIDE", "BENT", "CELLS", "CLOSING", "FINEST", "FLAT", "GAP", "NARROW", "NEAR_ZERO"),
        *("NEXT", "RESERVE", "RIM", "SEAM", "SHIFTS", "TOUCHED", "TURNED", "VANISHING"),
    )
}  # fmt: skip
CONSTANTS: dict[str, float | tuple[float, ...]] = dict(sorted((_NUMBERS | _OF_THE_SEARCH).items()))
"""The constants by their names in the runtimes."""
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
