"""Colours and sizes of a picture, in the units of its page."""

INK = "#22272e"
FAINT = "#6b7480"
LINK = "#8a95a3"
LINK_EDGE = "#5c6773"
ROD = "#a9b4c0"
PLATE = "#5f7a70"
BASE = "#c8b48c"
TURN = "#1d5fa8"
JOINT = "#dbe8f6"
SLIDE = "#b5481a"
BELT = "#3b3f46"
RAIL = "#ead9c8"
AXES = ("#c23b30", "#2d8a43", "#2f62b5")
PAPER = "#ffffff"

SHOWN = 400
"""The width at which a window shows a picture, in its pixels."""
WIDTH = 500.0
"""The width of the widest page, which a window shows 400 pixels wide, or even 320: letters are then 9 pixels high."""
TITLE, LABEL, NAME, SMALL = 16.0, 14.0, 16.0, 14.0
"""The sizes of letters."""
LINK_WIDTH, ROD_WIDTH, PLATE_WIDTH, BASE_WIDTH = 9.0, 5.0, 5.0, 5.0
JOINT_RADIUS = 11.0
ARC_RADIUS = 23.0
FRAME = 46.0
