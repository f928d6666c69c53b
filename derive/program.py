"""One degree in radians, and a choice, for mechanism files to import."""

from derive.ir.constants import DEGREE
from derive.ir.primitives import Select

__all__ = ["DEGREE", "Select"]
