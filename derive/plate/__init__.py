"""A platform that a loop turns, in a plane or in space: its closure, its singularities, its pose by iteration.

It may import the folders from `ir` to `solver`.

cones: the largest angle that the joints of a rod allow, from its direction at the home pose
legs: the legs (rods, and planes in which points stay) as lines: names, vectors, rows of the matrix A
newton: the pose by Newton's method on the lengths of the rods
passive: the coordinates that the loop moves but the task does not command
plate: the home pose, and the checks of the inverse
stated_rods: stated equations that are rods, or planes, whatever their form; lengths of rods that are positive
surplus: rods beyond those that hold a point or a platform: which they are, and whether they fit
tension: cables only pull: the tensions under a load
turning: forward kinematics by iteration, the joints at the home pose, sampled poses
turns: the rates of the angles of a platform; the twist of the least turn from home
"""
