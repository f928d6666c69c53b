"""All programs of one mechanism: forward and inverse, branches, Jacobian, margins, limits, couplings.

It may import the folders from `ir` to `optimize`. Of a branch, `sigma_elbow` = +1, a positive `branch_elbow` and
configuration byte 1 are the same.

branches/: which step of the derivation a branch is
build: from a description to all programs
bundle: all programs lowered together and checked; what never changes moved into the setup
coupling: what a coupling calls of an orientation kinematics, and which offsets are allowed
differential: the Jacobian, from A x' + B q' = 0
flange_rotation: how the flange turns: the programs of its rotation
forward: forward kinematics, and the values of the inverse derivation at given axis values
inverse: inverse kinematics of one branch, for a pose or for a point off the flange
kinematics: what all later folders read: every program of a mechanism, and what its names mean
margins/: the singularity margins of a machine that is solved in closed form
no_pose: why a machine has no pose at its nominal dimensions
number_of_joints: a refusal of more or fewer joints than the task commands quantities
parameters: all inputs of a machine, and the setup program
reference_cases: the data of a test on the controller: machines, calls, expected answers
sampling: samples of machines and axis values, for numerical decisions of the build
scan/: a mechanism with a root scan along one joint
shared_names: an input and a derived value with one name, found and derived again under another
"""
