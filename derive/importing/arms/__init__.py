"""An arm as lines in space, and its chain in the simple form: turns and shifts along x, y and z.

Like `importing`, it may import the folders from `ir` to `mechanisms`.

aligned: neighbouring axes at nearly a multiple of 15 degrees, put at it
conditions: how much each axis moves what a task commands, beyond what the other axes do
headings: the direction x, y or z along which every axis moves, and the fixed turns between their frames
lines: a robot as lines: the positions of its axes at joint values of zero
pieces: the chain of an arm in its simple form, with the fewest shifts
points: the point on its line at which every axis is placed, so that the fewest shifts remain
rounded: the exact values of angles that a file has rounded
snapping: simple angles and rotations near those of a file, and the record of such changes
tasks: the part of a commanded pose that a chain can follow, and the joints that have to be held
"""
