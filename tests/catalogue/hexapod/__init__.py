"""The hexapod: the whole pose, forward kinematics by iteration, one determinant as its margin."""
