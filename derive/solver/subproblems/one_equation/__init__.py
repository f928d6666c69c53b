"""An angle that one equation determines up to a sign, a cos u + b sin u = e, computed without loss of digits.

Like `solver`, it may import the folders from `ir` to `equations`.

amplitude: the length of (a, b) as a product, and its properties
apart: two equations from which a length was eliminated, where that length drops out of both
lateral: the rule where an arm with a lateral offset must reach a commanded point (a, b)
origin: the right side as its value at the origin plus an increment, without cancellation
other_leg: the leg of a chain that is nearly stretched along one coordinate, from the other two coordinates
small_entries: one less an entry of a rotation, without cancellation
triangle: the triangle whose law of cosines the right side is
trigonometric: the rule
"""
