"""Softkin_TableTable_AB: five axes, a table that turns about B on a trunnion A."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes("Softkin_TableTable_AB", table="AB", vendor=Vendor.TEXTBOOK, family="five_axis")
