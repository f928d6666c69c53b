"""Programs rewritten for speed: by the derivation itself (`simplify`), or for languages that gain by it.

It may import the folders from `ir` to `solver`.

angle_addition: angles added before their sines are taken, where a sine costs no more than a few products
coalesce: names that no later statement reads, given to the next branch
directions: the angle of a direction, without a sine and a cosine that nothing else reads
guards: a condition that holds where a root is positive, asked only where it is not
joining: a choice that an earlier choice decides, brought into that one
inline: what is read once and is short, written where it is read
regular: the program of poses where nothing is singular
rotation_identities: a cross product of two columns of a rotation, as its third column
simplify: what a derivation does twice or undoes again, done once
without_periods: angles and axes that may be a turn more or less
"""
