"""The workspace of a delta: which positions its three arms reach between their limits."""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import softkin  # noqa: E402

alike = {
    f"{name}_{leg}": value
    for leg in (1, 2, 3)
    for name, value in (("base_radius", 200.0), ("inner_arm", 235.0), ("outer_arm", 800.0), ("tcp_radius", 45.0))
}
limits = dict.fromkeys(("A1", "A2", "A3"), (-40.0, 80.0))
delta = softkin.DeltaP3CType3(azimuth_1=0.0, azimuth_2=120.0, azimuth_3=240.0, **alike, limits=limits)

ends = [delta.forward((angle,) * 3)[0].position[2] for angle in (-40.0, 80.0)]
print("on its axis, z goes from", round(min(ends), 1), "to", round(max(ends), 1))
side, heights = np.linspace(-900.0, 900.0, 181), np.linspace(-1050.0, -450.0, 61)
x, z = np.meshgrid(side, heights)
axes, statuses = delta.inverse_batch(np.stack([x, 0.0 * x, z], axis=-1).reshape(-1, 3))
reached = (statuses == softkin.Status.OK).reshape(x.shape)
print("reached:", int(reached.sum()), "of", reached.size, "positions")
widest = heights[reached.sum(axis=1).argmax()]
print("widest at z =", round(float(widest), 1))

plt.contourf(x, z, reached, levels=[0.5, 1.5])
plt.gca().set_aspect("equal")
plt.xlabel("x [mm]")
plt.ylabel("z [mm]")
plt.savefig(f"{sys.argv[1]}/workspace_of_a_delta.png", dpi=70)
