"""What a mechanism file needs of programs: one degree in radians, and a choice."""

from derive.ir.constants import DEGREE
from derive.ir.primitives import Select

__all__ = ["DEGREE", "Select"]
