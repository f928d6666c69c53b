"""The one form of a machine: two descriptions of the same machine have the same form, and derive alike.

One rule a module; each is an identity, which its docstring states. It may import the folders from `ir` to
`description`.

chain: the chain, read as lines of its zero pose and written again
deviations: a serial machine as it is, with its deviations from the drawing as inputs
directions: the directions of a rod's moved end, whose decimals become exact
gears: gears that stand in a chain, moved to the joints
headings: the letter x, y or z along which every line of a chain lies, and the turns between their frames
inner_names: the names that the inputs of a machine have inside a derivation
lines: a chain as lines of its zero pose, and the point of every turn on its line
machine: all rules, in their order; rods that end at the commanded point
numbers: names for the numbers of a chain, and for the angles of a loop, whose numbers become exact
roots: roots in the equations of a loop, squared
"""
