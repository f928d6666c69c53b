"""The turns and shifts that a chain is made of: what a mechanism file imports."""

from derive.geometry.frames import (
    Chain,
    Factor,
    Motion,
    Rx,
    Ry,
    Rz,
    Tx,
    Txyz,
    Ty,
    Tz,
    denavit_hartenberg,
    flip_x,
)

__all__ = [
    "Chain",
    "Factor",
    "Motion",
    "Rx",
    "Ry",
    "Rz",
    "Tx",
    "Txyz",
    "Ty",
    "Tz",
    "denavit_hartenberg",
    "flip_x",
]
