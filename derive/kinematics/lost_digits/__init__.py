"""If a closed form has lost digits, steps on the closure meet the pose.

Like `kinematics`, it may import the folders from `ir` to `optimize`.

starts: where the steps start: the attempts, and the closed form with nearly free angles turned
machine: what the steps need to know of a machine
closure_steps: the program that meets a pose by steps of damped least squares
doubts: refusals that lost digits may explain, and the branch that then takes these steps
"""
