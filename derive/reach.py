"""Arms and struts that reach a common point, for mechanism files to import."""

from derive.description.reach import discs_meet, three_to_a_point

__all__ = ["discs_meet", "three_to_a_point"]
