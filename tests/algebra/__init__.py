"""Searched arms, solved by algebra: all roots of a wave, a second way beside the scan of the compiler.

Both share the trial, which solves the other joints where one is known; how its roots are found is not shared.

The residual of a trial, multiplied over the signs of all roots, is a wave in the searched joint, of degree 8 for six
turning axes. So its zeros can be found without a gap: nothing that is a solution is missed.

product: the residual without roots
wave: the product as a sum of waves, and its rounding
parts: the parts of the circle in which the wave may be zero
closure: the trial, and steps on the closure from what it gives
settle: a start in a part, and the least residual next to it
search: the loop over parts and starts
"""
