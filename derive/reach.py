"""Conditions that arms can reach a common point, for mechanism files to import."""

from derive.description.reach import discs_meet

__all__ = ["discs_meet"]
