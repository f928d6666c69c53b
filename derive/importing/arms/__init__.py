"""An arm as lines in space, and its chain in its one form: turns and shifts along x, y and z.

Like `importing`, it may import the folders from `ir` to `mechanisms`.

lines: a robot as lines: the positions of its axes at joint values of zero
pieces: the chain of an arm in the one form of a machine, without what is nearly zero
rounded: the exact values of angles that a file has rounded
snapping: simple angles and rotations near those of a file, and the record of such changes
tasks: the part of a commanded pose that a chain can follow, the joints that have to be held, and how well each counts
"""
