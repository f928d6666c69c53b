"""Six-axis arms of any shape: with one joint known, the others follow from linear equations (Raghavan and Roth).

The chain is a ring: the last frame leads back to the base. Six joints a b c d e f follow one another around it. The
axis of f, seen from b, is turned by e, d and c on one way, and by a and b on the other. Fourteen values of a line with
a point are linear in every joint (`line`), so there are fourteen equations. Eight of them give the products of
cosines and sines of a and b; the other six hold only d and e, with c known. Multiplied by powers of the half angles of
d and e, they are as many linear equations as there are products of these powers. Their determinant vanishes where the
arm closes: it is the wave of the search. There, d and e follow from the vector that the matrix takes to zero.

line: values of a line with a point, and the motions that change them linearly
ring: the joints and the frames between them, in a circle
oblique: slides at any angle to the axes before and behind them
numbers: the equations at poses of random machines
order: the choice of the six letters, and of the equations
equations: the statements that compute the six equations
matrix: the linear equations for products of powers, and their determinant
vanishing: the joints at a value of the searched one
"""
