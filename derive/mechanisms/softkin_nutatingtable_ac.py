"""Softkin_NutatingTable_AC: five axes, a table that turns about C on a carrier with an inclined axis A."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes("Softkin_NutatingTable_AC", table="AC", nutating=True, vendor=Vendor.TEXTBOOK, family="five_axis")
