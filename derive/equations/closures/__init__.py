"""The closure equations: what they are, how a mechanism states them, and how what is commanded enters them.

Like `equations`, it may import the folders from `ir` to `mechanisms`.

closure: closure equations as data, in the coordinates of the task
commanded: the closure of a pose, of a pose with one joint known, of a point off the flange
fixed_names: names for what never moves: sines and cosines of fixed angles, roots of parameters
stated: the closure of a mechanism that states its equations, rods and guides
"""
