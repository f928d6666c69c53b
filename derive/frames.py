"""The turns and shifts that make a chain, for mechanism files to import."""

from derive.geometry.frames import Chain, Factor, Motion, Rx, Ry, Rz, Tx, Txyz, Ty, Tz, denavit_hartenberg, flip_x

__all__ = ["Chain", "Factor", "Motion", "Rx", "Ry", "Rz", "Tx", "Txyz", "Ty", "Tz", "denavit_hartenberg", "flip_x"]
