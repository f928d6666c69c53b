"""Orientation kinematics, and their coupling with position kinematics."""
