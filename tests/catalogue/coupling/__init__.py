"""Orientation kinematics, and what carries them."""
