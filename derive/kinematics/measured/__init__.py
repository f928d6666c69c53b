"""The true machine: all programs of a serial machine that has its deviations as inputs.

Like `kinematics`, it may import the folders from `ir` to `optimize`.

approach: a few steps of Newton's method, before the search of `lost_digits`
pose: the pose of the true chain, and its screws; between its first and its last turn, too
programs: the programs of the machine as it is drawn, changed to those of the machine as it is
system: a linear system in two parts of at most three equations, without a search for pivots
"""
