"""Softkin_NutatingHead_CB: five axes, a fork that turns about C carries a head with an inclined axis B."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes("Softkin_NutatingHead_CB", head="CB", nutating=True, vendor=Vendor.TEXTBOOK, family="five_axis")
