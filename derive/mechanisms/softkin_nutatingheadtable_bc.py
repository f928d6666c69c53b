"""Softkin_NutatingHeadTable_BC: five axes, a head with an inclined axis B over a table that turns about C."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes(
    "Softkin_NutatingHeadTable_BC", head="B", table="C", nutating=True, vendor=Vendor.TEXTBOOK, family="five_axis"
)
