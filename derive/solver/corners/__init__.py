"""Where singularities meet: angles are moved to where later steps have solutions, or free where no digits are left.

A fold is a pose where both roots of a step meet. Like `solver`, it may import the folders from `ir` to `equations`.

feasible_arc: a free angle, moved onto the arc on which later steps have solutions
folds: the angle of a step near its fold, turned to where a later step has a solution
lost_arms: an angle, free where the arm that it turns has rounded to nothing
short_arms: the angle of a step near its fold, turned until the arm of a later step is long enough
sweeps: a later angle, chosen first where an earlier one near its fold would turn it by any amount
where_free: the square of a length where an angle is free
within_legs: the sine of a step near zero, no larger than a later step can hold
"""
