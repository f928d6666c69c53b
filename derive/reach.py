"""What can reach, for constraints on the dimensions: what a mechanism file imports."""

from derive.description.reach import (
    discs_meet,
)

__all__ = [
    "discs_meet",
]
