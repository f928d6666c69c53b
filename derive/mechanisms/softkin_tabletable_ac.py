"""Softkin_TableTable_AC: five axes, a table that turns about C on a trunnion that tilts about A."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes("Softkin_TableTable_AC", table="AC", vendor=Vendor.TEXTBOOK, family="five_axis")
