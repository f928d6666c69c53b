"""A mechanism with a root search: both of its derivations, its trial with slopes, its inverse and its margins.

A trial solves all joints but one, which is known, and leaves a residual, which is zero at a root. Like `kinematics`,
it may import the folders from `ir` to `optimize`.

choice: the choice of the joint that is searched
derivations: the closed form and the trial, and the branches of their steps
elimination/: six-axis arms of any shape, whose other joints follow from linear equations
guards: the conditions under which a trial is within reach
inverse: the inverse: closed form and search in one program
margins: the margins
parts: parts of the circle in which the wave may vanish
product: the residual multiplied over the signs of its roots
programs: the trial, the joints at a joint value, the steps on the closure
samples: poses of random machines, by which decisions are made
search: the search for the root nearest to the reference, or the next one ahead
slopes: every value of a program, with its derivative by one input
starts: the starts in a part of the circle
tried: the trials in a part of the circle
wave: the product, or the determinant of an elimination, as a sum of waves in the joint
"""
