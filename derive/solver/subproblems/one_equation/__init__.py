"""An angle that one equation tells up to a sign, a cos u + b sin u = e, and what keeps its digits.

Like `solver`, it may import the folders from `ir` to `equations`.

amplitude: the length of (a, b) as a product, and what is known of it
apart: two equations from which a length was eliminated, where that length drops out of both
lateral: the rule where an arm with a lateral offset must reach a commanded point (a, b)
origin: the right side as its value at the origin plus an increment, without cancellation
other_leg: the leg of a chain that is nearly stretched along one coordinate, from the other two
small_entries: one less an entry of a rotation, without cancellation
triangle: the triangle whose law of cosines the right side is
trigonometric: the rule
"""
