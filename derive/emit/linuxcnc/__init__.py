"""Kinematics modules of LinuxCNC: one C source a mechanism, around what the language C writes of it."""
