"""Kinematics for Klipper without Klipper: its calls, pretended; and its proof, on steps that are made here."""
