"""Softkin_NutatingHead_CA: five axes in the head, a fork that turns about C and an inclined axis A on it."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes("Softkin_NutatingHead_CA", head="CA", nutating=True, vendor=Vendor.TEXTBOOK, family="five_axis")
