"""Calibration: where a SCARA is not as its drawing, from the points that a tracker saw."""

import numpy as np
import softkin

drawn = softkin.Scara4ZCcoupledType1(link_length_1=325.0, link_length_2=225.0, limits={"A3": (-150.0, 0.0)})
real = drawn.calibrated({"a1_offset": 0.31, "a2_offset": -0.42, "a3_tilt_x": 0.08, "tool_x": 0.18})  # nobody knows it

axes = np.array(softkin.propose(drawn, 20, rotations=False))
seen = real.forward_batch(axes)[0] + np.random.default_rng(5).normal(0.0, 0.01, (20, 3))
samples = {
    "A1": axes[:, 0],
    "A2": axes[:, 1],
    "A3": axes[:, 2],
    "A4": axes[:, 3],
    **dict(zip("xyz", seen.T, strict=True)),
}

found = softkin.calibrate(drawn, samples, parameters=["offset", "tilt", "tool"])
print("before:", round(found.before.position, 2), "mm, after:", round(found.after.position, 2), "mm")
print({name: round(value, 2) for name, value in found.deviations.items() if abs(value) > 5.0 * found.sigma[name]})
print("held:", ", ".join(found.held))
