"""A mechanism with a root search: both of its derivations, its trial with slopes, its inverse and its margins.

A trial solves all joints but one, which is known, and leaves a residual, which is zero at a root. Like `kinematics`,
it may import the folders from `ir` to `optimize`.

choice: the choice of the joint that is searched
derivations: the closed form and the trial, and the branches of their steps
elimination/: six-axis arms of any shape, whose other joints follow from linear equations
find: one loop, each pass of which makes one step of what the search is at
guards: the conditions under which a trial is within reach
inverse: the inverse: closed form and search in one program
margins: the margins
parts: a step around the circle on which the wave does not vanish
product: the residual of a trial multiplied over the signs of all its roots
programs: a trial, the joints that it gives, a step of all joints on the closure, and whether they are on the branch
samples: poses of random machines, by which decisions are made
slopes: every value of a program, with its derivative by one input
starts: the starts in a part of the circle in which the wave may vanish
tried: the trials in a part: the shortest length, the least residual next to a start
twins: two solutions that stand at one root
wave: the product, or the determinant of an elimination, as a sum of waves in the joint, and its rounding
"""
