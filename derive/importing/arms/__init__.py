"""An arm as lines in space, and its chain in the simple form: turns and shifts along x, y and z.

Like `importing`, it may import the folders from `ir` to `mechanisms`.

headings: along which of x, y and z every axis moves, and the fixed turns between their frames
lines: a robot as lines: where its axes stand at joint values of zero
pieces: the chain of an arm in its simple form, with the fewest shifts
points: where on its line every axis is placed, so that the fewest shifts remain
rounded: angles that a file has rounded, put back
snapping: simple angles and rotations near those of a file, and the record of what was moved
tasks: what a chain can follow of a commanded pose, and which joints have to be held
"""
