"""Colours and sizes of a picture, in pixels."""

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

TITLE, LABEL, NAME, SMALL = 18.0, 13.0, 15.5, 13.0
"""The sizes of letters. The smallest are still letters where a window shows the page at two thirds of its width."""
LINK_WIDTH, ROD_WIDTH, PLATE_WIDTH, BASE_WIDTH = 9.0, 5.0, 5.0, 5.0
JOINT_RADIUS = 11.0
ARC_RADIUS = 25.0
FRAME = 58.0
