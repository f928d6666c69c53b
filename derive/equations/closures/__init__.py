"""The closure equations as data, as a mechanism states them, and with the commanded coordinates in them.

Like `equations`, it may import the folders from `ir` to `mechanisms`.

closure: closure equations as data, in the coordinates of the task
commanded: the closure of a pose, of a pose with one joint known, of a point off the flange
fixed_names: names for constants of a machine: sines and cosines of fixed angles, roots of parameters
stated: the closure of a mechanism that states its equations, rods and guides
"""
