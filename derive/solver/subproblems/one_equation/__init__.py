"""An angle that one equation tells up to a sign: the rule, the arm and the triangle, and what keeps its digits."""
