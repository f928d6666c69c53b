"""The emitted Structured Text: its form, its contract, and its answers; every method is compared with the same method
in Python.

Units of serial machines stand here, those of closed loops in `loops`, orientation kinematics in `coupling`, the plate
that moves with its whole pose in `hexapod`, the self-test for a controller in `selftest`.
"""
