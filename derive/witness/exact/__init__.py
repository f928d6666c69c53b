"""The exact check: programs against the closure of the description, in a finite field.

Errors below 1e-12 do not exclude a formula that is nearly right. Closed forms are algebraic: with random lengths, and
random points of c^2 + s^2 = 1 for the joints, the closure must vanish exactly. A wrong identity of degree d passes one
trial with a probability below d/2^61.

described: the description as the field can hold it
field: the field, its square roots, and the sines and cosines of fixed angles
proof: machines and poses are drawn, programs are evaluated, the closure is asked
runs: programs in the field; if a root may have either sign, both are tried
values: numbers that remember what they are as angles
"""
