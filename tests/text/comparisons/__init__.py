"""The comparisons: by method of a block, its expected answer, from the same method in Python or from the description.

A test runs for every method that stands in the emitted text, and looks it up here: one that is missing fails.
"""

from collections.abc import Callable

from tests.text.comparisons import axes, configurations, initialization, offsets, orientations, poses, velocities
from tests.text.pairs import Pair
from tests.text.samples import Sample

Comparison = Callable[[Pair, Sample], None]

COMPARISONS: dict[str, Comparison] = {
    "Initialize": initialization.initialize,
    "IsInitialized": initialization.initialize,
    "GetKinematicsName": initialization.name,
    "GetAxisProperties": axes.axis_properties,
    "AxisSettings": axes.axis_settings,
    "AxesToCartesian": poses.forward,
    "CartesianToAxes": poses.inverse,
    "AxesToOrientation": orientations.orientation,
    "IsSingularity": velocities.singularity,
    "Jacobian": velocities.jacobian,
    "Margins": velocities.margins,
    "AxisVelocities": velocities.axis_velocities,
    "AxisAccelerations": velocities.axis_accelerations,
    "JacobianFrom": velocities.from_start(velocities.jacobian),
    "MarginsFrom": velocities.from_start(velocities.margins),
    "AxisVelocitiesFrom": velocities.from_start(velocities.axis_velocities),
    "AxisAccelerationsFrom": velocities.from_start(velocities.axis_accelerations),
    "InitializeReason": initialization.why_initialize,
    "Diagnose": poses.diagnose,
    "GetOrientationImage": orientations.image,
    "GetFlangeOrientationImageTotal": orientations.image,
    "GetFlangeOrientationImageWithOri": orientations.image_with_orientation,
    "AxesToConfiguration_Offset": offsets.configuration_offset,
    "CartesianToAxes_Offset": offsets.inverse_offset,
    "GetConfigurationDataSize": configurations.configuration_size,
    "GetDefaultConfigurationData": configurations.default_configuration,
    "CPConnectible": configurations.connectible,
    "ActivateAutomaticRotaryPeriods": configurations.automatic_periods,
    "IsConfigSingular": configurations.singular_configuration,
    "GetPeriods": configurations.periods,
}
"""By the name of the method."""

POSELESS = {
    "InitializeReason", "Initialize", "IsInitialized", "GetKinematicsName", "GetAxisProperties", "AxisSettings",
    "GetOrientationImage", "GetFlangeOrientationImageTotal", "GetConfigurationDataSize",
}  # fmt: skip
"""Methods that no pose goes into: a few samples of a machine are enough."""
