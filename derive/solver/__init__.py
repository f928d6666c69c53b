"""How the closure is solved: a driver that applies rules until no unknown is left.

It may import the folders from `ir` to `equations`.

derivation: what it gives: statements, and the steps in which they were found
derivation_record: the statements of a derivation: known legs and equal values under one name, every name bound once
eliminations: equations with fewer unknowns, made from others, in tiers
meeting_axes: the equation of a joint behind which two axes meet
parallel_axes: a sum of angles about parallel axes, as one unknown
positive_steps: two-root steps of which only one root belongs to the machine
probe: the unknowns on which a sum of squares depends, found numerically
solve: the driver
subproblems/: the rules
unsolved: the error `Unsolved`: why no rule fits what is left, and what would help
"""
