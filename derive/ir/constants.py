"""The numerical constants of the product. Each is defined here and nowhere else."""

from __future__ import annotations

import sympy as sp

DEGREE = sp.Symbol("DEGREE", positive=True)
"""One degree in radians: a named constant of every language."""
FREE_ANGLE = sp.Float("2e-12")
"""Conditioning over its scale at or below this leaves the angle of a step free. The pose is missed by twice as much, a
chord of 2, and two angles may be free at once: together that is less than 1e-11.
"""
COINCIDENT = sp.Float("1e-11")
"""A branch byte reads 3 where the scaled margin of the branch is at most this."""
KNOWN_ANGLE = sp.Float("0.1")
"""Conditioning over its scale above this gives the angle of a step to 1e-15: there is hardly a reason to move it."""
OUT_OF_REACH = sp.Float("1e-9")
"""A pose that exceeds a bound by more than this share is not reached by moving an angle that is known."""
BOUNDARY = sp.Float("1e-12")
"""A normalised radicand negative by at most this is zero: the boundary belongs to the workspace."""
ROUNDING = sp.Float("1e-12")
"""A motion of the pose smaller than this share of the machine is rounding."""
ROUNDING_OF_SUMS = sp.Float("1e-15")
"""The rounding of a sum of lengths, or of their squares, as a share of the scale of the machine, or of its square."""
LARGEST_MISS = sp.Float("1e-3")
"""A surplus rod fits a pose where it misses by at most this share of its length, unless a length is given."""
LARGEST = sp.Integer(10) ** 9
"""Inputs larger in size than this are refused, and so are answers: an axis without limits ends here."""
ROTATION = sp.Float("1e-4")
"""How far the product of a rotation with its transpose may be from the identity: some frames come from single
precision."""
EXACT_ROTATION = sp.Float("1e-12")
"""A matrix nearer to a rotation than this is used as it is; one that is further away is repaired."""
SURE_ROTATION = sp.Float("1e-13")
"""A matrix that misses x x = y y = 1, x y = 0 and z = x × y by no more than this is nearer to a rotation than
`EXACT_ROTATION`."""
SAME_ROTATION = sp.Float("1e-6")
"""A commanded rotation is reached where the angle to it is at most this many radians: that is rounding."""
LEAST = sp.Float("1e-12")
"""A length or a ratio that may not be zero is refused at this size or less, so that products of such numbers, and
their reciprocals, stay finite."""
PLANE = sp.Float("1e-6")
"""How far a planar machine's commanded z may be from its plane, per unit of reach."""
LIMIT = sp.Float("1e-9")
"""Relative tolerance of an axis limit."""
SHORTEST_LINK = sp.Float("1e-9")
"""An effective link shorter than this fraction of the machine's scale cannot be aimed."""
HELD = sp.Float("1e-9")
"""A shift up to this share of all shifts may turn with a flange unnoticed. Axes up to this share apart count as
one axis."""
SINGULAR = sp.Float("1e-3")
"""A pose is singular where a margin is smaller than this in size."""
PIVOT = sp.Float("1e-14")
"""A matrix is singular where no pivot is larger than this share of its largest entry."""
SOLVABLE = sp.Float("1e30")
"""Linear equations are solved where all their numbers are at most this size, and the largest at least its
reciprocal."""
CONVERGED = sp.Float("1e-11")
"""An iteration has converged where the error of every length is at most this share of the machine's scale."""
NEARLY = sp.Float("1e-6")
"""A root of a search counts as on a branch where its scaled margin has the wrong sign by no more than this, which is
the square root of `BOUNDARY`."""
MET = sp.Float("1e-10")
"""A root of a search meets the pose where its error is at most this share of the machine's scale, and at most this
many radians."""
DOUBTFUL = sp.Float("1e-2")
"""A step whose margin is at most this may have lost digits that a later step needs; there its angle is set free."""
NEARLY_FREE = sp.Float("1e-5")
"""The same where the nearest value of a free angle is sought ever closer: there more angles are determined."""
FEWEST_STARTS = 1000
"""So often at least the search for all poses of a platform begins, in each assembly mode."""
MOST_STARTS = 20000
"""And so often at most: it ends earlier where it has come to every pose often enough."""
OFTEN = 4
"""It has come often enough to a pose to which it has come so often."""
SAME_POSE = sp.Float("1e-5")
"""Poses are one where they differ by less, of the size of the machine and of the entries of a rotation."""
STARTS = 13
"""The values of nearly free angles, all around the circle, from which steps towards a pose are taken."""
SCANNED = 61
"""The values of free angles that are tried, all around the circle, to find the start of which one step leaves least."""
NEAR = sp.Float("1e-2")
"""Values beside the nearest are tried if one step from it leaves no larger an error than this."""
REFINED = 52
"""So many more beside the nearest, at half the distance each second time: up to 1e-7 radians. The error grows with the
square of the distance where a link is stretched, so that the nearest is met within `BOUNDARY`.
"""
LATTICE = 17
"""The angle of joint k, counted from 0, is turned this to the power of k times as far, modulo `SCANNED`: the values of
several free angles are a lattice. It is prime to `SCANNED`.
"""
PASSES = 64
"""The largest number of steps from one start: next to a double root every step leaves a third of the error."""
STALLED = sp.Float("0.999")
"""A step towards a pose that leaves more than this share of the error makes hardly any progress."""
STALLS = 20
"""A start is given up behind so many steps that came hardly nearer to the pose."""
HARDLY_NEARER = sp.Float("0.99")
"""A step came hardly nearer that leaves more than this share of the least error so far."""
MOST_STEPS = 450
"""The largest number of steps from all starts together; with deviations more go towards a goal that is moved."""
COST_OF_A_STALL = 8
"""As many steps are given up for it: a pose that the machine does not have ends after a few."""
LONGEST_STEP = sp.Rational(1, 2)
"""The longest step towards a pose, in radians and lengths of the machine."""
SHARE_OF_DAMPING = sp.Float("1e-3")
"""The damping of such a step, as a share of the error: it lets the steps end fast where solutions are not isolated."""
LEAST_DAMPING = sp.Float("1e-13")
"""The least damping of such a step, so that the equations stay solvable."""
TIE = sp.Float("1e-6")
"""An automatic choice takes a later branch only where its squared distance (degrees) is smaller by more than this."""
TIE_SHARE = sp.Float("1e-6")
"""The same for linear axes: a later branch must be nearer by more than the square of this share of the scale."""
ONE_TURN = sp.Integer(350)
"""An axis has one value inside its limits where they are at most this far apart (degrees): no step of a path crosses
the gap."""
GEARED_TURN = sp.Float("350.001")
"""`ONE_TURN` for a joint with a gear: in degrees of the joint, between limits that tolerances have widened."""
EDGE = sp.Float("1e-9")
"""How far (degrees) the intervals of the periods are shifted down: see `NearestPeriod`."""
