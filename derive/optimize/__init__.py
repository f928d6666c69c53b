"""Programs rewritten for speed: by the derivation itself (`simplify`), or for languages that gain by it.

It may import the folders from `ir` to `solver`.

angle_addition: angles added before their sines are taken, where a sine costs no more than a few products
coalesce: names that no later statement reads, given to the next branch
directions: the angle of a direction is computed without a sine and a cosine that nothing else reads
inline: a short value that is read once is written where it is read
joining: a later choice that an earlier choice decides is moved into the earlier one
regular: the program for poses where nothing is singular
rotation_identities: the cross product of two columns of a rotation is its third column
simplify: steps of a derivation that repeat or undo each other are removed
without_periods: angles and axes that may be a turn more or less keep their first value
"""
