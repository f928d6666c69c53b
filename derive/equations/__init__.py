"""What has to be solved: closure equations, chains split on both sides, axes and their turns.

It may import the folders from `ir` to `mechanisms`.

Without a commanded turn an axis takes its one value inside limits that are at most 350° apart, else the value nearest
to the reference. Limits refuse, and never choose: where another turn is inside them, the reason gives its number.

axes: axis values to joint values and back, the choice of a turn, the checks of inputs, the pose at axis values
chain_splits: a chain as T = L M S (Paul, Pieper), and the equations of its position at the best split
choices: flags and signs of a machine, which are numbers in equations and choices in programs
closures/: the closure equations: as data, as a mechanism states them, and for the commanded coordinates
conditions: values of parameters that must not vanish where the derivation is to hold
drives: joints that loops move: from the motor to the joint and back
known_turns: rotations that are known: their matrices, and names for their entries
limits: the test of the limits
machine_checks: checks of a derivation that parameters alone decide
named_pose: the pose of a spatial chain, with a name for every entry of every frame
pitch/: arms whose last turns alone follow the commanded rotation
positions: the equations of the commanded position for the joints that are still unknown
problem: the problem that a rule gets, and the binding that it answers
rotation_repair: the repair of a commanded rotation, once a call, before every other program
rotations: the equations of the commanded rotation for the joints that are still unknown
trigonometry: sines and cosines by their names
windows: the range of every axis: constants of a machine, made of its limits
"""
