"""An angle that one equation determines up to a sign, a cos u + b sin u = e, computed without loss of digits.

Like `solver`, it may import the folders from `ir` to `equations`.

amplitude: the length of (a, b) as a product, and its properties
lateral: the rule where an arm with a lateral offset must reach a commanded point (a, b)
other_leg: the leg of a chain that is nearly stretched along one coordinate, from the other two coordinates
small_entries: one less an entry of a rotation, without cancellation
triangle: the triangle whose law of cosines the right side is
trigonometric: the rule
"""
