"""Calibration: the offsets of the axes and the second link, by least squares from measured positions."""

import numpy as np
import softkin
from scipy.optimize import least_squares

drawn = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0)
real = drawn.changed(offset_a1=0.31, offset_a2=-0.42, link_length_2=225.18)  # nobody knows this machine

rng = np.random.default_rng(5)
axes = rng.uniform((-120.0, 20.0, -50.0, -90.0), (120.0, 140.0, 0.0, 90.0), (40, 4))
measured = real.forward_batch(axes)[0] + rng.normal(0.0, 0.01, (40, 3))


def machine(x):
    return drawn.changed(offset_a1=x[0], offset_a2=x[1], link_length_2=x[2])


def missed(x):
    return (machine(x).forward_batch(axes)[0] - measured).ravel()


start = np.array([0.0, 0.0, 225.0])
found = least_squares(missed, start, x_scale=(0.1, 0.1, 0.1))
print("before:", round(float(np.sqrt(np.mean(missed(start) ** 2))), 2), "mm")
print("after:", round(float(np.sqrt(np.mean(found.fun**2))), 2), "mm")
print("offsets and length:", found.x.round(2).tolist())
