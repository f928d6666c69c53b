"""The step of the derivation that decides each branch: named branches, unnamed branches, assembly modes.

Like `kinematics`, it may import the folders from `ir` to `optimize`.

assembly: assembly modes: the sign of the determinant of forward kinematics that belongs to each mode
assignment: the two-root step whose determinant has the sign of a branch's indicator
derived: branches that the description does not name, named by the determinants of their steps
"""
