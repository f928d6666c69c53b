"""Softkin_HeadHead_CB: five axes, a fork that turns about C carries a head that tilts about B."""

from derive.five_axes import five_axes
from derive.mechanism import Vendor

MECHANISM = five_axes("Softkin_HeadHead_CB", head="CB", vendor=Vendor.TEXTBOOK, family="five_axis")
