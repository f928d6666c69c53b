"""A mechanism with a root search: both of its derivations, its trial with slopes, its inverse and its margins.

A trial solves all joints but one, which is known, and leaves a residual, which is zero at a root. Like `kinematics`,
it may import the folders from `ir` to `optimize`.

choice: the choice of the joint that is searched
derivations: the closed form and the trial, and the branches of their steps
elimination/: six-axis arms of any shape, whose other joints follow from linear equations
guards: the conditions under which a trial is within reach
inverse: the inverse: closed form and search in one program
loop/: the search itself, and the steps from the reference that come before it
margins: the margins
product: the residual of a trial multiplied over the signs of all its roots
programs: a trial, the joints that it gives, a step of all joints on the closure, and whether they are on the branch
samples: poses of random machines, by which decisions are made
slopes: every value of a program, with its derivative by one input
tool_turn: the turn of a tool about its line, a further joint where a direction is commanded
wave: the product, or the determinant of an elimination, as a sum of waves in the joint, and its rounding
"""
