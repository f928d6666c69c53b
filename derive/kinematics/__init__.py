"""All programs of one mechanism: forward and inverse, branches, Jacobian, margins, limits, couplings.

It may import the folders from `ir` to `optimize`. For a branch, `sigma_elbow` = +1, a positive `branch_elbow` and
configuration byte 1 mean the same.

bias: the acceleration of the frame at constant speeds of the axes
branches/: the step of the derivation that decides each branch
build: from a description to all programs
bundle: all programs lowered together and checked, with constants moved into the setup
coupling: the programs that a coupling calls of an orientation kinematics, and the allowed offsets
differential: the Jacobian, from A x' + B q' = 0, and that of a platform from the lines of its legs
flange_rotation: the rotations that the flange can have: their programs
forward: forward kinematics, and the values of the inverse derivation at given axis values
inverse: inverse kinematics of one branch, for a pose or for a point off the flange
kinematics: the bundle that all later folders read: every program of a mechanism, the meanings of its names, test cases
lost_digits/: where a closed form has lost digits, steps on the closure meet the pose
margins: the singularity margins of a machine that is solved in closed form
measured/: the programs of a serial machine that has its deviations as inputs
parameters: all inputs of a machine, and the setup program
rates: forward-mode differentiation of statements
refusals/: why a machine is refused
sampling: samples of machines and axis values, for numerical decisions of the build; how often home finds a pose again
search/: a mechanism with a root search along one joint
shared_names: where an input has the name of a derived value, the mechanism is derived again with another name
solution: what is solved of a machine before programs are made, in the one order of the preparations
"""
