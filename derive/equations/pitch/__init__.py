"""The last turns of a chain, where they alone follow the commanded rotation: pitch, and roll about the tool's axis.

The joints before them turn the plane in which the pitch moves the tool, and the position determines these joints. Once
they are known, the commanded direction is projected to that plane and normalised: that is the nearest direction that
the machine can reach. The roll then is the turn nearest to the remaining commanded rotation. For a rotation that the
machine can reach both are exact.

Like `equations`, it may import the folders from `ir` to `mechanisms`.

chain: which turns of a chain follow the commanded rotation
equations: the equations of the pitch and of the roll
heading: the joint that turns the plane of the arm, where the position leaves this joint free
"""
