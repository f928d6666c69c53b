"""The arc tangent of several poses at a time, held against forty digits."""

import numpy as np
from mpmath import mp

from derive.emit.native import coefficients, horner

OCTANT = np.sqrt(2.0) - 1.0
LAST_DIGIT = 2.0**-52


def test_the_last_digit() -> None:
    """From tiny angles to 22.5 degrees the polynomial misses by less than one unit of the last digit."""
    context = mp.clone()
    context.dps = 40
    even, odd = horner("zz")
    t = np.concatenate([np.linspace(1e-9, OCTANT, 2000), np.geomspace(1e-300, OCTANT, 500)])
    z = t * t
    p = eval(even, {"zz": z * z}) + z * eval(odd, {"zz": z * z})
    worst = max(abs(float(context.atan(a) - v)) / a for a, v in zip(t, t + t * z * p, strict=True))
    assert worst < LAST_DIGIT


def test_the_series() -> None:
    """The first coefficients are nearly those of the series: -1/3, 1/5, -1/7."""
    assert np.allclose(coefficients()[:3], [-1 / 3, 1 / 5, -1 / 7], rtol=0, atol=1e-9)
