"""A mechanism with a root search: both of its derivations, its trial with slopes, its inverse and its margins.

A trial solves all joints but one, which is known, and leaves a residual, which is zero at a root. Like `kinematics`,
it may import the folders from `ir` to `optimize`.

candidates: all candidates for a root in closed form, where the residual is a conic
choice: the choice of the joint that is searched
conic: where the unit circle meets a conic
derivations: the closed form and the trial, and the branches of their steps
guards: the conditions under which a trial is within reach
inverse: the inverse: closed form and scan in one program
margins: the margins
own_side: the root on one side of a trial, next to an angle at which the conic meets the circle
parabola: a step towards a root that may be double
position_first: the position of an arm with a spherical wrist, improved before the wrist follows it
programs: the trial, the search for the root nearest to the reference, the joints at a root
quartic: the residual as a conic in cosine and sine of the joint, where it is one
slopes: every value of a program, with its derivative by one input
waves: the values of a program as waves in one angle
"""
