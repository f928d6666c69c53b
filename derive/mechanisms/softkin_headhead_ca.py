"""Softkin_HeadHead_CA: five axes, a fork that turns about C carries a head that tilts about A."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes("Softkin_HeadHead_CA", head="CA", vendor=Vendor.TEXTBOOK, family="five_axis")
