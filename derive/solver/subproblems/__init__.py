"""Solved subproblems: one rule a module; each knows one shape of equation and no mechanism.

Like `solver`, it may import the folders from `ir` to `equations`.

affine_system: M v = e, for two or three lengths v, or one length along a direction
direction: cos u : sin u = along : across, for an angle u, which other rules lead to
naming: one name for each known value
one_equation/: a cos u + b sin u = e, for an angle u
pair: two equations that are linear in cos u and sin u, for an angle u
polar: f cos v = a and f sin v = b, for an angle v and a length f
quadratic: a v² + b v + c = 0, for a length v
shortfall: how much is missing where a step has no root
spheres: where two circles or three spheres meet, for all unknown lengths
two_slides: three equations in space for two unknown lengths, of a trial whose turns the rotation gives
"""
