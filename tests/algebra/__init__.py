"""Searched arms, solved by algebra: all roots of a wave, a second way beside the scan of the compiler.

Both share the trial, which solves the other joints where one is known; how its roots are found is not shared.

The residual of a trial, multiplied over the signs of all roots, is a wave in the searched joint, of degree 8 for six
turning axes. So its zeros can be found without a gap: nothing that is a solution is missed.

product: the residual without roots
wave: the product as a sum of waves, and its rounding
parts: a step around the circle on which the wave does not vanish
closure: the trial, a step on the closure from what it gives, and whether joints are on the branch
starts: the starts in a part of the circle in which the wave may vanish
tried: the trials in a part: the least residual next to a start
search: one loop, each pass of which makes one step of what the search is at
"""
