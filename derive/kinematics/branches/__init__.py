"""Which step of the derivation a branch is: of those that a description names, of others, and of assembly modes.

Like `kinematics`, it may import the folders from `ir` to `optimize`.

assembly: assembly modes: which sign of the determinant of forward kinematics is which mode
assignment: the two-root step whose determinant has the sign of a branch's indicator
derived: branches that the description does not name, named by the determinants of their steps
"""
