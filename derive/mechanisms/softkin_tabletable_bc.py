"""Softkin_TableTable_BC: five axes, a table that turns about C on a trunnion that tilts about B."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes("Softkin_TableTable_BC", table="BC", vendor=Vendor.TEXTBOOK, family="five_axis")
