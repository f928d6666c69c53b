"""Kinematics modules of LinuxCNC, compiled against stand-ins for its headers, and held against Python."""
