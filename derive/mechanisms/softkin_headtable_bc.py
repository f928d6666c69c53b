"""Softkin_HeadTable_BC: five axes, a head that tilts about B over a table that turns about C."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes("Softkin_HeadTable_BC", head="B", table="C", vendor=Vendor.TEXTBOOK, family="five_axis")
